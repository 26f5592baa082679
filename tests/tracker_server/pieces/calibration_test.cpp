#include "tracker_server/pieces/calibration.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

constexpr double step = 60;
constexpr BoardLight daylight{step, 4};

// A square as noisy pictures show it: `structure` and `difference` in grey levels, each off by up to a fifth.
CellLook look(double structure, double difference, double darker, std::mt19937& random) {
  std::uniform_real_distribution<float> off(0.8F, 1.2F);
  CellLook cell;
  cell.seen = true;
  cell.structure = static_cast<float>(structure) * off(random);
  cell.difference = static_cast<float>(difference) * off(random);
  cell.ground = {100, 10, 20};
  cell.middle = {100 - static_cast<float>(darker) * off(random), 10, 20};
  return cell;
}

// Twenty weak pieces and thirty squares that noise makes as busy as those: only the colour tells them apart.
std::vector<KnownSquare> start_position(std::mt19937& random, double light = 1) {
  std::vector<KnownSquare> squares;
  for (int i = 0; i < 50; ++i) {
    const bool taken = i < 20;
    const CellLook cell = look(15 * light, (taken ? 30 : 14) * light, (taken ? 20 : 9) * light, random);
    squares.push_back({features_of(cell, step * light), taken});
  }
  return squares;
}

int right(const SquareCalibration& calibration, const std::vector<KnownSquare>& squares) {
  int count = 0;
  for (const KnownSquare& square : squares) count += (calibration.score(square.features) > 0) == square.taken;
  return count;
}

TEST(Calibration, TheStartPositionTeachesWhatAPieceLooksLike) {
  std::mt19937 random(3);
  SquareCalibration calibration;
  EXPECT_FALSE(calibration.ready());
  calibration.learn(start_position(random), daylight);
  ASSERT_TRUE(calibration.ready());
  for (int picture = 0; picture < 20; ++picture) EXPECT_EQ(right(calibration, start_position(random)), 50);
}

TEST(Calibration, MoreOrLessLightChangesNothing) {
  std::mt19937 random(4);
  SquareCalibration calibration;
  calibration.learn(start_position(random), daylight);
  EXPECT_EQ(right(calibration, start_position(random, 0.6)), 50);
  EXPECT_EQ(right(calibration, start_position(random, 1.5)), 50);
  EXPECT_FALSE(calibration.too_dark({0.6 * step, 2.4}));
  EXPECT_TRUE(calibration.too_dark({0.1 * step, 0.4}));
}

// The lamps go down to a third, the camera's noise stays: empty squares look busier, measured by the light, than pieces
// did before.
TEST(Calibration, NoiseInDimLightIsNotTakenForPieces) {
  std::mt19937 random(7);
  const auto squares = [&](double light, double noise) {
    const BoardLight seen{step * light, std::hypot(4 * light, noise)};
    std::vector<CellLook> looks;
    for (int i = 0; i < 50; ++i) {
      CellLook cell = look((i < 20 ? 12 : 4) * light, (i < 20 ? 30 : 26) * light, (i < 20 ? 20 : 17) * light, random);
      cell.structure = std::hypot(cell.structure, static_cast<float>(noise));
      looks.push_back(cell);
    }
    return std::pair{looks, seen};
  };
  const auto known = [](const std::vector<CellLook>& looks, double scale, const ExtraNoise& extra) {
    std::vector<KnownSquare> result;
    for (std::size_t i = 0; i < looks.size(); ++i) result.push_back({features_of(looks[i], scale, extra), i < 20});
    return result;
  };
  SquareCalibration calibration;
  const auto [bright, daylit] = squares(1, 1);
  calibration.learn(known(bright, daylit.step, {}), daylit);
  ASSERT_TRUE(calibration.ready());
  const auto [dim, dusk] = squares(0.35, 3.2);
  ASSERT_FALSE(calibration.too_dark(dusk));
  EXPECT_EQ(right(calibration, known(dim, dusk.step, calibration.extra_noise(dusk))), 50);
  EXPECT_LT(right(calibration, known(dim, dusk.step, {})), 40) << "this light is no trial";
}

TEST(Calibration, ABoardThatStandsOtherwiseTeachesNothing) {
  std::mt19937 random(5);
  std::vector<KnownSquare> turned = start_position(random);
  for (std::size_t i = 0; i < turned.size(); ++i) turned[i].taken = i >= 30;
  SquareCalibration calibration;
  calibration.learn(turned, daylight);
  EXPECT_FALSE(calibration.ready());
  // Empty as the board is before it is set up.
  std::vector<KnownSquare> bare = start_position(random);
  for (std::size_t i = 0; i < 20; ++i) bare[i] = {bare[i + 20].features, true};
  calibration.learn(bare, daylight);
  EXPECT_FALSE(calibration.ready());
  // And once it has learned, it does not unlearn.
  calibration.learn(start_position(random), daylight);
  for (int picture = 0; picture < 200; ++picture) calibration.learn(turned, daylight);
  EXPECT_EQ(right(calibration, start_position(random)), 50);
}

TEST(Calibration, AMoveThatIsNotKnownYetDoesNotDisturbIt) {
  std::mt19937 random(6);
  SquareCalibration calibration;
  for (int picture = 0; picture < 300; ++picture) {
    std::vector<KnownSquare> squares = start_position(random);
    squares[19].taken = false;
    squares[25].taken = true;
    calibration.learn(squares, daylight);
  }
  ASSERT_TRUE(calibration.ready());
  EXPECT_EQ(right(calibration, start_position(random)), 50);
}

}  // namespace
}  // namespace counterpart
