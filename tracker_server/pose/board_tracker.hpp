// The board followed from frame to frame: started and found again by itself, and honest about being lost.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/pose.hpp"
#include "tracker_server/edges/picture_view.hpp"
#include "tracker_server/locate/locate.hpp"
#include "tracker_server/pose/chequer_check.hpp"
#include "tracker_server/pose/fit.hpp"
#include "tracker_server/pose/gradient_fit.hpp"
#include "tracker_server/pose/joined_model.hpp"
#include "tracker_server/pose/lens_estimator.hpp"
#include "tracker_server/pose/motion.hpp"
#include "tracker_server/pose/reference_fit.hpp"

namespace counterpart {

enum class FocalMode : std::uint8_t { fixed = 1, estimate = 2 };

struct BoardTrackerOptions {
  BoardGeometry board;
  std::optional<Intrinsics> camera;  // empty: of unknown focal length, which is estimated
  FocalMode focal = FocalMode::fixed;
  bool estimate_lens = false;  // principal point and distortion, too, once the board was seen from several sides
  Predictor predictor = Predictor::first;
  Optimizer optimizer;
  std::vector<PlacedModel> fixtures;  // what does not move on the board, or beside it; frame B
};

struct TrackedBoard {
  TrackStatus status = TrackStatus::lost;
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  Intrinsics camera;
  PoseFit fit;         // how it was fitted; of the last attempt if that failed
  ChequerCheck check;  // of the same pose
  // Found again turned so far from where it was last held that it may as well lie the other way round: see turn_round.
  bool either_way_round = false;
};

class BoardTracker {
 public:
  explicit BoardTracker(const BoardTrackerOptions& options);

  // Starts from a known pose (a saved one), or from outer corners in any order, in the next picture.
  void start_at(const Eigen::Isometry3d& X_CB);
  void start_at(const std::array<Eigen::Vector2d, 4>& corners_px);
  void forget();

  // time_ns grows from call to call. The picture's size may change: the tracker then starts afresh.
  TrackedBoard track(const cv::Mat& picture_bgr, std::int64_t time_ns);

  // The board is lying the other way round than was thought: turns the frame B by 180 degrees.
  void turn_round();

  const std::vector<EdgeSample>& samples() const { return samples_; }
  const Model& model() const { return model_; }

 private:
  struct Attempt {
    PictureView view;  // that it was made in
    PoseFit fit;
    ChequerCheck check;
    bool good = false;
    bool smeared = false;  // by motion: aligned with the reference view, not by edges
    bool either_way_round = false;
  };
  Attempt attempt(const PictureView& view, const Eigen::Isometry3d& start, const std::vector<FitRound>& rounds) const;
  bool held_by_fixtures(const PoseFit& fit) const;
  bool doubtful(const Attempt& attempt) const;
  std::optional<Attempt> one_step_back(const PictureView& view, const Attempt& attempt) const;
  Attempt brought_back(const PictureView& view, Attempt attempt) const;
  double outline_share(const PoseFit& fit) const;
  std::optional<Attempt> follow_nearby(const cv::Mat& picture_bgr, std::int64_t time_ns) const;
  Attempt follow(const PictureView& view, std::int64_t time_ns) const;
  Attempt follow_smeared(const PictureView& view, std::int64_t time_ns, Attempt sharp) const;
  Attempt aligned(const PictureView& view, const ReferenceFit& fit) const;
  double way_px(const Eigen::Isometry3d& X_CB) const;
  void keep_reference(const Attempt& attempt);
  void forget_looks();
  void predict_zoom();
  bool follow_light(const PoseFit& fit);
  std::optional<Attempt> find(const cv::Mat& picture_bgr, const PictureView& view);
  std::optional<Attempt> from_located(const LocatedBoard& located, const PictureView& view);
  void accept(const Attempt& attempt, std::int64_t time_ns);
  void learn(const Attempt& attempt);
  void adopt(const Calibration& calibration);

  BoardTrackerOptions options_;
  Model model_;
  std::vector<EdgeSample> samples_;  // the board's first, then those of the fixtures
  std::size_t board_samples_ = 0;
  Motion motion_;
  Intrinsics camera_;
  FocalPrior focal_;
  std::optional<LensEstimator> lens_;
  double zoom_rate_ = 0;     // change of the log focal length a picture
  double contrast_ = 0;      // grey levels between light and dark squares
  double last_support_ = 0;  // of the last pose that was believed
  std::optional<Eigen::Isometry3d> last_X_CB_;
  std::optional<Eigen::Isometry3d> held_X_CB_;  // the last one that was followed for long: which side is which
  int frames_held_ = 0;                         // since the board was found
  std::optional<ReferenceView> reference_;
  double reference_way_px_ = 0;  // that the board had gone since the picture before
  int reference_age_ = 0;        // frames
  std::optional<Eigen::Isometry3d> start_X_CB_;
  std::optional<std::array<Eigen::Vector2d, 4>> start_corners_;
  int frames_unseen_ = 0;
  bool tracking_ = false;
  bool ever_seen_ = false;
};

}  // namespace counterpart
