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

// Noise does not go down with the light: in a dim picture it makes empty squares busy. In steps.
struct ExtraNoise {
  double square = 0;  // of what the picture has more of it than usual
  double least = 0;   // no square is less busy than this without it
};

SquareFeatures features_of(const CellLook& look, double step, const ExtraNoise& extra = {});

struct KnownSquare {
  SquareFeatures features;
  bool taken = false;
};

// Two classes with means and a common scatter, told apart along Fisher's direction. Follows slow changes.
class SquareCalibration {
 public:
  // One picture's known squares. Pictures in which too few squares of either kind are known teach nothing. Squares may
  // be known wrongly now and then: a picture in which many look otherwise than they are said to be is not believed.
  // Returns whether anything was learned.
  bool learn(const std::vector<KnownSquare>& squares, const BoardLight& light);

  // False until empty squares and pieces have been told apart well.
  bool ready() const { return ready_; }

  // -1: as the usual empty square, 1: as the usual piece. Only if ready.
  double score(const SquareFeatures& features) const;

  // Compared with the pictures that were learned from.
  ExtraNoise extra_noise(const BoardLight& light) const;

  // Whether so little light has come since that what is learned does not hold.
  bool too_dark(const BoardLight& light) const;

 private:
  void update();

  bool ready_ = false;
  bool begun_ = false;
  BoardLight light_;
  SquareFeatures empty_ = SquareFeatures::Zero(), taken_ = SquareFeatures::Zero();
  Eigen::Matrix<double, 5, 5> scatter_ = Eigen::Matrix<double, 5, 5>::Zero();
  SquareFeatures direction_ = SquareFeatures::Zero();
};

}  // namespace counterpart
