#include "stage/film/film.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace counterpart::stage {
namespace {

Scenario clean_scenario() {
  Scenario scenario;
  scenario.player_present = false;
  scenario.sensor = {0, 0};
  return scenario;
}

// Where along a line across an edge the picture's brightness crosses the mean of both sides, in pixels from the middle;
// NaN if there is no clear step.
double edge_offset_px(const cv::Mat& grey, const Eigen::Vector2d& middle, const Eigen::Vector2d& across) {
  constexpr int kReach = 5;
  constexpr int kSteps = 10;  // a pixel
  std::vector<double> profile;
  for (int i = -kReach * kSteps; i <= kReach * kSteps; ++i) {
    const Eigen::Vector2d at = middle + across * (static_cast<double>(i) / kSteps);
    const int x = static_cast<int>(std::floor(at.x()));
    const int y = static_cast<int>(std::floor(at.y()));
    if (x < 0 || y < 0 || x + 1 >= grey.cols || y + 1 >= grey.rows) return std::nan("");
    const double fx = at.x() - x;
    const double fy = at.y() - y;
    profile.push_back((1 - fy) * ((1 - fx) * grey.at<std::uint8_t>(y, x) + fx * grey.at<std::uint8_t>(y, x + 1)) +
                      fy * ((1 - fx) * grey.at<std::uint8_t>(y + 1, x) + fx * grey.at<std::uint8_t>(y + 1, x + 1)));
  }
  const auto mean = [&](std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += profile[i];
    return sum / static_cast<double>(to - from);
  };
  const double before = mean(0, 25);
  const double after = mean(profile.size() - 25, profile.size());
  if (std::abs(before - after) < 30) return std::nan("");
  // The area between the step and its two levels gives its place with all of the profile, not just one sample.
  double area = 0;
  for (const double value : profile) area += (value - before) / (after - before) / kSteps;
  return kReach - area + 0.5 / kSteps;
}

// Mean and spread of all grid lines' offsets, from the middles of the squares' sides, where no piece reaches.
struct Agreement {
  double mean_abs_of_lines = 0, worst_line = 0;
  int lines = 0;
};

Agreement grid_agreement(const Shot& shot, const BoardGeometry& board) {
  cv::Mat grey;
  cv::cvtColor(shot.image_bgr, grey, cv::COLOR_BGR2GRAY);
  const View& view = shot.truth.view;
  const int n = board.squares;
  const double size = board.square_size_m;
  const double half = n * size / 2;
  Agreement result;
  for (const bool along_x : {true, false}) {
    for (int line = 1; line < n; ++line) {
      double sum = 0;
      int count = 0;
      for (int cell = 0; cell < n; ++cell) {
        for (const double share : {0.4, 0.5, 0.6}) {
          const double s = (cell + share) * size - half;
          const double at = line * size - half;
          const Eigen::Vector3d p = along_x ? Eigen::Vector3d(s, at, 0) : Eigen::Vector3d(at, s, 0);
          const Eigen::Vector3d step = along_x ? Eigen::Vector3d(1e-4, 0, 0) : Eigen::Vector3d(0, 1e-4, 0);
          const Eigen::Vector2d tangent = (project(view, p + step) - project(view, p - step)).normalized();
          // From light to dark or back does not matter: the sign is that of the line's one side.
          const double offset = edge_offset_px(grey, project(view, p), {-tangent.y(), tangent.x()});
          if (std::isnan(offset)) continue;
          sum += offset;
          ++count;
        }
      }
      if (count < 10) continue;
      const double mean = std::abs(sum / count);
      result.mean_abs_of_lines += mean;
      result.worst_line = std::max(result.worst_line, mean);
      ++result.lines;
    }
  }
  result.mean_abs_of_lines /= std::max(1, result.lines);
  return result;
}

Shot empty_board(Scenario scenario) {
  // Without pieces: they would hide parts of the lines. A crowned view from nearly above makes squares large.
  scenario.path.eye_B = {0.1, 0.35, 0.75};
  scenario.path.target_B = {0, 0, 0};
  scenario.no_pieces = true;
  return Film::begin(scenario).value().next();
}

// The truth must agree with the picture: a line's mean offset over some 30 places, each good to about 0.1 px because of
// the wood's grain, is good to about 0.03 px.
TEST(Film, GridLinesLieWhereTheTruthProjectsThem) {
  const Scenario scenario = clean_scenario();
  const Agreement agreement = grid_agreement(empty_board(scenario), scenario.board);
  EXPECT_GE(agreement.lines, 16);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.05);
  EXPECT_LT(agreement.worst_line, 0.12);
}

TEST(Film, AndSoTheyDoThroughADistortedLens) {
  Scenario scenario = clean_scenario();
  scenario.intrinsics.dist = {-0.22, 0.06, 0.001, -0.001, 0};
  const Agreement agreement = grid_agreement(empty_board(scenario), scenario.board);
  EXPECT_GE(agreement.lines, 16);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.06);
  EXPECT_LT(agreement.worst_line, 0.15);
}

TEST(Film, SameSeedSameBytes) {
  Scenario scenario;
  scenario.player.practise = true;
  reseed(scenario, 4);
  Film a = Film::begin(scenario).value();
  Film b = Film::begin(scenario).value();
  reseed(scenario, 5);
  Film c = Film::begin(scenario).value();
  double difference = 0;
  for (int i = 0; i < 12; ++i) {
    const Shot shot_a = a.next();
    const Shot shot_b = b.next();
    ASSERT_EQ(cv::norm(shot_a.image_bgr, shot_b.image_bgr, cv::NORM_INF), 0) << "frame " << i;
    difference += cv::norm(shot_a.image_bgr, c.next().image_bgr, cv::NORM_INF);
  }
  EXPECT_GT(difference, 0);
}

TEST(Film, TimeIsTheFramesNumber) {
  Film film = Film::begin(clean_scenario()).value();
  EXPECT_EQ(film.next().truth.stamp, (FrameStamp{0, 0}));
  EXPECT_EQ(film.next().truth.stamp, (FrameStamp{1, 40'000'000}));
}

TEST(Film, ArmMaskIsWhereTheArmIs) {
  Scenario scenario;
  scenario.player.practise = true;
  Film film = Film::begin(scenario).value();
  int most = 0;
  for (int i = 0; i < 45; ++i) {
    film.next();
    if (film.world().hand.held_piece >= 0) most = std::max(most, cv::countNonZero(film.arm_mask()));
  }
  EXPECT_GT(most, 3000);
  EXPECT_LT(most, 720 * 576 / 3);
}

}  // namespace
}  // namespace counterpart::stage
