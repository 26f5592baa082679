// What an empty square and a piece look like on this board, to this camera, in this light: learned from squares whose
// contents are known, so that nobody sets a threshold by hand.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tracker_server/pieces/appearance.hpp"

namespace counterpart {

// How busy a square is, how much it differs from its own corners, and in which direction of colour. In units of the
// step between the board's two colours, which goes up and down with the light.
using SquareFeatures = Eigen::Matrix<double, 5, 1>;

SquareFeatures features_of(const CellLook& look, double step);

struct KnownSquare {
  SquareFeatures features;
  bool taken = false;
};

// Two classes with means and a common scatter, told apart along Fisher's direction. Follows slow changes.
class SquareCalibration {
 public:
  // One picture's known squares; step: between the board's two colours, grey levels. Pictures in which too few squares
  // of either kind are known teach nothing. Squares may be known wrongly now and then: a picture in which many look
  // otherwise than they are said to be is not believed.
  void learn(const std::vector<KnownSquare>& squares, double step);

  // False until empty squares and pieces have been told apart well.
  bool ready() const { return ready_; }

  // -1: as the usual empty square, 1: as the usual piece. Only if ready.
  double score(const SquareFeatures& features) const;

  // Whether so little light has come since that what is learned does not hold.
  bool too_dark(double step) const;

 private:
  void update();

  bool ready_ = false;
  bool begun_ = false;
  double step_ = 0;
  SquareFeatures empty_ = SquareFeatures::Zero(), taken_ = SquareFeatures::Zero();
  Eigen::Matrix<double, 5, 5> scatter_ = Eigen::Matrix<double, 5, 5>::Zero();
  SquareFeatures direction_ = SquareFeatures::Zero();
};

}  // namespace counterpart
