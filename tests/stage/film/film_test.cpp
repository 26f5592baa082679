#include "stage/film/film.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vhd_renderer/body/build_character.hpp"

namespace counterpart::stage {
namespace {

Scenario clean_scenario() {
  Scenario scenario;
  scenario.player_present = false;
  scenario.sensor = {0, 0};
  return scenario;
}

// Where along a line across an edge the picture's brightness crosses the mean of both sides, in pixels from the middle;
// NaN if there is no clear step. The sides are taken from half of `reach` to `reach`.
double edge_offset_px(const cv::Mat& grey, const Eigen::Vector2d& middle, const Eigen::Vector2d& across,
                      int reach = 5) {
  constexpr int kSteps = 10;  // a pixel
  std::vector<double> profile;
  for (int i = -reach * kSteps; i <= reach * kSteps; ++i) {
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
  const auto side = static_cast<std::size_t>(reach * kSteps / 2);
  const double before = mean(0, side);
  const double after = mean(profile.size() - side, profile.size());
  if (std::abs(before - after) < 30) return std::nan("");
  // The area between the step and its two levels gives its place with all of the profile, not just one sample.
  double area = 0;
  for (const double value : profile) area += (value - before) / (after - before) / kSteps;
  return reach - area + 0.5 / kSteps;
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

Shot empty_board(Scenario scenario, int frame = 0) {
  // Without pieces: they would hide parts of the lines. A crowned view from nearly above makes squares large.
  scenario.path.eye_R = {0.1, 0.35, 0.75};
  scenario.path.target_R = {0, 0, 0};
  scenario.no_pieces = true;
  Film film = Film::begin(scenario).value();
  for (int i = 0; i < frame; ++i) film.next();
  return film.next();
}

// A later frame of a scenario that says what its camera or board does.
Agreement agreement_in(const std::string& what, int frame) {
  Scenario scenario = parse_scenario(R"({"player": {"present": false}, )" + what + "}").value();
  scenario.sensor.blur_px = scenario.sensor.noise = 0;
  return grid_agreement(empty_board(scenario, frame), scenario.board);
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

// Seen at some 60 degrees a warp of up to 3 mm moves places of the lines by up to a pixel, a line's mean by less; a
// flat board's lines are 0.05 pixels off at most. The plane that fits the top best is still where the truth has it.
TEST(Film, AWarpedBoardShowsItsLinesBesideThePlane) {
  Scenario scenario = clean_scenario();
  scenario.warp_m = 0.003;
  const Agreement agreement = grid_agreement(empty_board(scenario), scenario.board);
  EXPECT_GE(agreement.lines, 16);
  EXPECT_GT(agreement.mean_abs_of_lines, 0.08);
  EXPECT_LT(agreement.worst_line, 1);
}

TEST(Film, AndSoTheyDoThroughADistortedLens) {
  Scenario scenario = clean_scenario();
  scenario.intrinsics.dist = {-0.22, 0.06, 0.001, -0.001, 0};
  const Agreement agreement = grid_agreement(empty_board(scenario), scenario.board);
  EXPECT_GE(agreement.lines, 16);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.06);
  EXPECT_LT(agreement.worst_line, 0.15);
}

// The mean offset of all lines that run in one direction through a box of the picture; NaN if there are few places.
double mean_offset_px(const Shot& shot, const BoardGeometry& board, bool along_x, const cv::Rect& box) {
  cv::Mat grey;
  cv::cvtColor(shot.image_bgr, grey, cv::COLOR_BGR2GRAY);
  const double size = board.square_size_m;
  const double half = board.squares * size / 2;
  double sum = 0;
  int count = 0;
  for (int line = 1; line < board.squares; ++line) {
    for (double s = -half; s < half; s += size / 30) {
      const double in_cell = std::fmod(s + half, size) / size;
      if (in_cell < 0.15 || in_cell > 0.85) continue;  // the crossings are no edges
      const double at = line * size - half;
      const Eigen::Vector3d p = along_x ? Eigen::Vector3d(s, at, 0) : Eigen::Vector3d(at, s, 0);
      const Eigen::Vector2d seen = project(shot.truth.view, p);
      if (!box.contains(cv::Point(static_cast<int>(seen.x()), static_cast<int>(seen.y())))) continue;
      const Eigen::Vector3d step = along_x ? Eigen::Vector3d(1e-4, 0, 0) : Eigen::Vector3d(0, 1e-4, 0);
      const Eigen::Vector2d tangent =
          (project(shot.truth.view, p + step) - project(shot.truth.view, p - step)).normalized();
      const double offset = edge_offset_px(grey, seen, {-tangent.y(), tangent.x()}, 2);
      if (std::isnan(offset)) continue;
      sum += offset;
      ++count;
    }
  }
  return count < 30 ? std::nan("") : sum / count;
}

// The board fills the picture, seen through lenses that bend lines both ways. A place is good to about 0.2 px because
// of the wood's grain; the mean of at least 30 of them to 0.04 px.
TEST(Film, LinesLieWhereTheTruthProjectsThemInEveryCornerOfThePicture) {
  for (const std::array<double, 5>& dist :
       {std::array<double, 5>{0, 0, 0, 0, 0}, std::array<double, 5>{-0.25, 0.07, 0.001, -0.0008, 0},
        std::array<double, 5>{0.12, 0.03, -0.001, 0.001, 0}}) {
    Scenario scenario = clean_scenario();
    scenario.no_pieces = true;
    scenario.intrinsics.dist = dist;
    scenario.path.eye_R = {0.01, 0.02, dist[0] > 0 ? 0.30 : 0.25};
    scenario.path.target_R = {0, 0, 0};
    Film film = Film::begin(scenario).value();
    const Shot shot = film.next();
    for (const int x : {0, 540}) {
      for (const int y : {0, 432}) {
        for (const bool along_x : {true, false}) {
          const double offset = mean_offset_px(shot, scenario.board, along_x, {x, y, 180, 144});
          EXPECT_LT(std::abs(offset), 0.1) << "k1 " << dist[0] << " corner " << x << "," << y << " along x " << along_x;
        }
      }
    }
  }
}

// Without direct light there are no shadows: what differs from the picture without the box is the box.
TEST(Film, AnObjectIsSeenWhereItsPoseSays) {
  const std::string rest = R"("light": 0.0, "player": {"present": false},
      "camera": {"noise": 0, "blur_px": 0, "distortion": [-0.2, 0.05, 0, 0, 0]}})";
  const Scenario with = parse_scenario(R"({"objects": [{"kind": "box", "at_mm": [-400, 50], "turn_deg": 25,
      "by_mm": [60, 0], "period_s": 1}], )" +
                                       rest)
                            .value();
  Film with_box = Film::begin(with).value();
  Film without = Film::begin(parse_scenario("{" + rest).value()).value();
  Shot shot;
  cv::Mat empty;
  for (int i = 0; i < 6; ++i) {
    shot = with_box.next();
    empty = without.next().image_bgr;
  }
  ASSERT_EQ(shot.truth.objects.size(), 1u);
  View view = shot.truth.view;
  view.X_CB = shot.truth.objects[0].X_CO;
  std::vector<cv::Point> outline;  // the lens bends edges: many points of each
  const PolygonModel model = polygon_model(with.objects[0].kind, with.objects[0].size_m);
  for (const std::vector<int>& face : model.faces) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d a = model.vertices_O[static_cast<std::size_t>(face[i])];
      const Eigen::Vector3d b = model.vertices_O[static_cast<std::size_t>(face[(i + 1) % 4])];
      for (int k = 0; k <= 20; ++k) {
        const Eigen::Vector2d at = project(view, a + k / 20.0 * (b - a));
        outline.emplace_back(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
      }
    }
  }
  std::vector<cv::Point> hull;
  cv::convexHull(outline, hull);
  cv::Mat expected(empty.size(), CV_8UC1, cv::Scalar(0)), difference, seen, grown;
  cv::fillConvexPoly(expected, hull, 255);
  cv::dilate(expected, grown, cv::Mat());
  cv::absdiff(shot.image_bgr, empty, difference);
  cv::cvtColor(difference, seen, cv::COLOR_BGR2GRAY);
  seen = seen > 0;
  const int size = cv::countNonZero(expected);
  EXPECT_GT(size, 5000);
  EXPECT_GT(cv::countNonZero(seen & expected), 0.9 * size) << "but for places of the table's colour";
  EXPECT_LT(cv::countNonZero(seen & ~grown), 0.002 * size);
}

TEST(Film, TruthFollowsTheZoom) {
  const std::string zoom = R"("camera": {"zoom_range": [0.7, 1.3], "zoom_period_s": 1})";
  const Agreement agreement = agreement_in(zoom, 8);
  EXPECT_GE(agreement.lines, 14);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.06);
}

TEST(Film, TruthFollowsTheBoard) {
  const Agreement agreement = agreement_in(
      R"("events": [{"kind": "nudge_board", "at_s": 0, "for_s": 0.2, "by_mm": [25, -10], "turn_deg": 12}])", 4);
  EXPECT_GE(agreement.lines, 16);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.06);
}

// The picture runs by at 6 pixels a frame and the shutter is open for all of it: if the blur were not centred on the
// stamp, lines would lie up to 3 pixels off.
TEST(Film, MotionBlurIsCentredOnTheStamp) {
  const Agreement agreement = agreement_in(R"("camera": {"sweep_px_per_frame": 6, "shutter_ms": 40})", 30);
  EXPECT_GE(agreement.lines, 8);
  EXPECT_LT(agreement.mean_abs_of_lines, 0.2);
}

TEST(Film, RollingShutterShearsThePictureRoundItsMiddleRow) {
  Scenario scenario = parse_scenario(R"({"player": {"present": false}, "board": {"empty": true},
      "camera": {"sweep_px_per_frame": 8, "rolling_ms": 36, "noise": 0}})")
                          .value();
  Film rolling = Film::begin(scenario).value();
  scenario.shutter.readout_s = 0;
  Film global = Film::begin(scenario).value();
  Shot a, b;
  for (int i = 0; i < 30; ++i) {
    a = rolling.next();
    b = global.next();
  }
  EXPECT_TRUE(a.truth.view.X_CB.isApprox(b.truth.view.X_CB, 1e-12));
  const auto difference = [&](int row) {
    return cv::norm(a.image_bgr.rowRange(row, row + 8), b.image_bgr.rowRange(row, row + 8), cv::NORM_L1);
  };
  EXPECT_LT(difference(284), 0.5 * difference(440));
}

TEST(Film, InterlacedFieldsAreHalfAPeriodApart) {
  Scenario scenario = parse_scenario(
                          R"({"player": {"present": false}, "camera": {"sweep_px_per_frame": 8, "interlaced": true,
      "noise": 0, "blur_px": 0}})")
                          .value();
  Film film = Film::begin(scenario).value();
  for (int i = 0; i < 67; ++i) film.skip();  // half a circle, where the picture runs sideways
  const cv::Mat picture = film.next().image_bgr;
  // The rows of one field are of one moment: they are more alike than those of the two fields, though twice as far
  // apart.
  const auto rows_apart = [&](int rows) {
    return cv::norm(picture.rowRange(0, 570), picture.rowRange(rows, 570 + rows), cv::NORM_L1);
  };
  EXPECT_LT(rows_apart(2), 0.7 * rows_apart(1));
}

TEST(Film, TheNewspaperHidesTheShareThatIsAskedFor) {
  for (const double share : {0.3, 0.8}) {
    Scenario scenario = clean_scenario();
    scenario.events = {Event{EventKind::cover, 0, 4, 0, {0, 0}, 0, 0, share}};
    Film film = Film::begin(scenario).value();
    for (int i = 0; i < 40; ++i) film.next();
    EXPECT_NEAR(film.next().truth.edges_hidden, share, 0.02);
  }
}

TEST(Film, LightsGoOutAndComeBack) {
  Scenario scenario = clean_scenario();
  scenario.events = {Event{EventKind::lights, 0.2, 0.6, 0.04}};
  Film film = Film::begin(scenario).value();
  std::vector<double> brightness;
  for (int i = 0; i < 25; ++i) brightness.push_back(cv::mean(film.next().image_bgr)[1]);
  EXPECT_LT(brightness[12], 0.5 * brightness[0]);
  EXPECT_NEAR(brightness[24], brightness[0], 0.01);
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

// The hand of the whole player is where the player's hand is, and what he hides is hidden.
TEST(Film, TheWholePlayerHoldsWhatThePlayerHolds) {
  Scenario scenario;
  scenario.player.practise = true;
  scenario.player_figure = "mannequin";
  scenario.path.eye_R = {1.05, -0.35, 0.70};
  scenario.path.target_R = {0, 0.22, 0.10};
  Film film = Film::begin(scenario).value();
  const Figure figure = figure_of("mannequin").value();
  const auto joint = [&](const std::string& name) {
    const auto at = std::find_if(figure.joints.begin(), figure.joints.end(),
                                 [&](const Joint& candidate) { return candidate.name == name; });
    return static_cast<std::size_t>(at - figure.joints.begin());
  };
  int held = 0;
  for (int i = 0; i < 60; ++i) {
    const Shot shot = film.next();
    const World& world = film.world();
    ASSERT_TRUE(world.seated);
    const cv::Mat mask = film.arm_mask();
    EXPECT_GT(cv::countNonZero(mask), 30000) << "trunk and head";
    if (world.hand.held_piece < 0) continue;
    ++held;
    // Thumb and forefinger end on both sides of the piece: their last joints are a finger's bone off its middle.
    for (const char* name : {"r_thumb3", "r_index3"}) {
      const Eigen::Vector3d tip = world.seated->X_RJ.at(joint(name)).translation().cast<double>();
      EXPECT_LT((tip - world.X_RB * world.hand.pinch_B).norm(), 0.05) << name << " in frame " << i;
    }
    EXPECT_GT(shot.truth.hand_share, 0.02);
    EXPECT_LT(shot.truth.hand_share, 0.6);
  }
  EXPECT_GT(held, 10);
}

TEST(Film, APlayersFigureThatIsNotThereIsNamed) {
  Scenario scenario;
  scenario.player_figure = "/nowhere/nobody.glb";
  const auto film = Film::begin(scenario);
  ASSERT_FALSE(film);
  EXPECT_NE(film.error().message.find("/nowhere/nobody.glb"), std::string::npos) << film.error().message;
}

}  // namespace
}  // namespace counterpart::stage
