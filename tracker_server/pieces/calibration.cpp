#include "tracker_server/pieces/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace counterpart {
namespace {

constexpr std::size_t fewest = 3;      // known squares of each kind
constexpr double rate = 0.04;          // of a picture: light changes over seconds
constexpr double trusted_share = 0.9;  // of the known squares must look as they are said to be
constexpr double clearly_apart = 2.5;  // standard deviations between the two kinds
constexpr double least_scatter = 0.1;  // of a feature: a clean start position says little about later squares
constexpr double dark_share = 0.25;    // of the usual step between the board's colours

}  // namespace

SquareFeatures features_of(const CellLook& look, double step, const ExtraNoise& extra) {
  const double scale = std::max(step, 1.0);
  const Colour offset = look.middle - look.ground;
  // Independent of what stands there, noise adds to it as squares.
  const double busy = std::max(look.structure, 0.5F) / scale;
  const double least = std::min(busy, extra.least);
  SquareFeatures features;
  features << 0.5 * std::log2(std::max(busy * busy - extra.square, least * least)),
      std::log2(std::max(look.difference, 0.5F) / scale), offset.light / scale, offset.red_green / scale,
      offset.warm_cold / scale;
  return features;
}

bool SquareCalibration::learn(const std::vector<KnownSquare>& squares, const BoardLight& light) {
  if (!(light.step >= 1)) return false;
  std::array<SquareFeatures, 2> mean{SquareFeatures::Zero(), SquareFeatures::Zero()};
  std::array<std::size_t, 2> count{};
  for (const KnownSquare& square : squares) {
    if (ready_ && (score(square.features) > 0) != square.taken) continue;
    mean[square.taken] += square.features;
    ++count[square.taken];
  }
  if (count[0] < fewest || count[1] < fewest) return false;
  if (static_cast<double>(count[0] + count[1]) < trusted_share * static_cast<double>(squares.size())) return false;
  for (const std::size_t kind : {0U, 1U}) mean[kind] /= static_cast<double>(count[kind]);
  Eigen::Matrix<double, 5, 5> scatter = Eigen::Matrix<double, 5, 5>::Zero();
  for (const KnownSquare& square : squares) {
    if (ready_ && (score(square.features) > 0) != square.taken) continue;
    const SquareFeatures off = square.features - mean[square.taken];
    scatter += off * off.transpose() / static_cast<double>(count[0] + count[1] - 2);
  }
  const double share = begun_ ? rate : 1;
  begun_ = true;
  empty_ += share * (mean[0] - empty_);
  taken_ += share * (mean[1] - taken_);
  scatter_ += share * (scatter - scatter_);
  if (light.floor > 0) light_.floor += (light_.floor > 0 ? share : 1) * (light.floor - light_.floor);
  light_.step += share * (light.step - light_.step);
  update();

  if (ready_) return true;
  // The first lesson is believed only if what it says holds for the squares that it comes from.
  ready_ = true;
  const auto as_said = std::count_if(squares.begin(), squares.end(), [&](const KnownSquare& square) {
    return (score(square.features) > 0) == square.taken;
  });
  const double apart = std::sqrt(std::max(0.0, direction_.dot(taken_ - empty_)));
  const bool pieces_stand_out = taken_[1] > empty_[1];
  ready_ = begun_ = pieces_stand_out && apart > clearly_apart &&
                    static_cast<double>(as_said) >= trusted_share * static_cast<double>(squares.size());
  return ready_;
}

void SquareCalibration::update() {
  Eigen::Matrix<double, 5, 5> scatter = scatter_;
  scatter.diagonal().array() += least_scatter * least_scatter;
  direction_ = scatter.ldlt().solve(taken_ - empty_);
}

double SquareCalibration::score(const SquareFeatures& features) const {
  const double apart = direction_.dot(taken_ - empty_);
  return apart > 0 ? 2 * direction_.dot(features - 0.5 * (empty_ + taken_)) / apart : 0;
}

ExtraNoise SquareCalibration::extra_noise(const BoardLight& light) const {
  if (!ready_ || !(light.step > 0) || !(light.floor > 0) || !(light_.floor > 0)) return {};
  constexpr double play = 1.15;  // from picture to picture
  const double now = light.floor / light.step, usual = light_.floor / light_.step;
  if (now < play * usual) return {};
  return {now * now - play * play * usual * usual, 0.7 * usual};
}

bool SquareCalibration::too_dark(const BoardLight& light) const {
  return ready_ && light.step < dark_share * light_.step;
}

}  // namespace counterpart
