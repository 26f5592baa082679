#include "tracker_server/pipeline/observe.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/edges/pyramid.hpp"
#include "tracker_server/pipeline/debug_view.hpp"
#include "tracker_server/pose/board_tracker.hpp"
#include "tracker_server/pose/plane_pose.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

BoardTrackerOptions tracker_options(const ObserveOptions& options) {
  BoardTrackerOptions result;
  result.board = options.board;
  // Numbers that are no camera are worse than none.
  if (options.intrinsics && fault_of(*options.intrinsics).empty()) result.camera = options.intrinsics;
  return result;
}

std::array<Vector2d, 4> points_of(const std::array<double, 8>& corners) {
  return {Vector2d(corners[0], corners[1]), Vector2d(corners[2], corners[3]), Vector2d(corners[4], corners[5]),
          Vector2d(corners[6], corners[7])};
}

// Measures one step of the pipeline by its name.
template <class Step>
auto timed(std::map<std::string, double>& step_ms, const char* name, const Step& step) {
  const auto start = std::chrono::steady_clock::now();
  auto result = step();
  step_ms[name] = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

// A focal length that is being estimated moves a little with every frame. Those who draw with it are told of a new one
// only when that shows: until then the pose is put in terms of the old.
bool worth_telling(const Intrinsics& told, const Intrinsics& camera) {
  constexpr double shows = 0.003;
  Intrinsics scaled = told;
  scaled.fx = camera.fx;
  scaled.fy = camera.fy;
  scaled.id = camera.id;
  return scaled != camera || !(std::abs(camera.fx / told.fx - 1) <= shows) ||
         !(std::abs(camera.fy / told.fy - 1) <= shows);
}

void settle_intrinsics(const BoardGeometry& board, TrackedBoard& seen, Intrinsics& told) {
  seen.camera.id = told.id;
  if (seen.camera == told) return;
  if (worth_telling(told, seen.camera)) {
    const std::uint32_t id = told.id + 1;
    told = seen.camera;
    told.id = id;
  } else if (seen.status != TrackStatus::lost) {
    seen.X_CB = pose_through_camera(seen.X_CB, seen.camera, told, board);
  }
  seen.camera = told;
}

PoseEstimate estimate_of(const TrackedBoard& seen, const FrameStamp& stamp, std::uint32_t intrinsics_id) {
  PoseEstimate pose;
  pose.stamp = stamp;
  pose.status = seen.status;
  pose.X_CB = to_pose(seen.X_CB);
  pose.rms_px = static_cast<float>(seen.fit.rms_px);
  pose.seen_share = static_cast<float>(seen.fit.share());
  pose.intrinsics_id = intrinsics_id;
  if (seen.status == TrackStatus::ok || seen.status == TrackStatus::relocalised) {
    Eigen::Matrix<double, 6, 6> information = seen.fit.information.topLeftCorner<6, 6>();
    information.diagonal().array() += 1e-9;
    const Eigen::Matrix<double, 6, 6> covariance = information.inverse();
    std::size_t i = 0;
    for (int row = 0; row < 6; ++row)
      for (int col = row; col < 6; ++col) pose.covariance[i++] = static_cast<float>(covariance(row, col));
  }
  return pose;
}

std::string letters_of(const Occupancy& occupancy) {
  std::string letters;
  for (const CellSight& cell : occupancy.cells) {
    switch (cell.reading) {
      case CellReading::empty:
        letters += 'e';
        break;
      case CellReading::dark:
        letters += 'd';
        break;
      case CellReading::light:
        letters += 'l';
        break;
      case CellReading::piece:
        letters += 'p';
        break;
      case CellReading::unknown:
        letters += '?';
        break;
    }
  }
  return letters;
}

// From squares (column, row) on the board to the picture.
BoardToPixel board_to_pixel(const TrackedBoard& seen, const BoardGeometry& board) {
  const double D = board.square_size_m, half = 0.5 * board.squares * D;
  return [X_CB = seen.X_CB, camera = seen.camera, D, half](double column, double row) -> Vector2d {
    const Vector3d p_C = X_CB * Vector3d(column * D - half, half - row * D, 0);
    if (!(p_C.z() > 1e-6)) return {-1, -1};
    return project(camera, p_C);
  };
}

// One square of the cover, seen straight from above, into the picture.
void draw_cover(const cv::Mat1b& part, const Vector2d& a, const Vector2d& b, const Vector2d& c, cv::Mat1b& hidden) {
  Eigen::Matrix2d across;
  across << b - a, c - a;
  if (!(std::abs(across.determinant()) > 1e-6)) return;
  const Eigen::Matrix2d back = across.inverse();
  const Vector2d low = a.cwiseMin(b).cwiseMin(c).cwiseMin(b + c - a),
                 high = a.cwiseMax(b).cwiseMax(c).cwiseMax(b + c - a);
  const int left = std::max(0, static_cast<int>(low.x())),
            right = std::min(hidden.cols - 1, static_cast<int>(high.x()) + 1);
  const int top = std::max(0, static_cast<int>(low.y())),
            bottom = std::min(hidden.rows - 1, static_cast<int>(high.y()) + 1);
  constexpr double seam = 0.03;  // squares are no parallelograms in the picture: they overlap rather than gape
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const Vector2d at = back * (Vector2d(x, y) - a);
      if (at.minCoeff() < -seam || at.maxCoeff() >= 1 + seam) continue;
      const int row = std::clamp(static_cast<int>(at.y() * part.rows), 0, part.rows - 1);
      const int col = std::clamp(static_cast<int>(at.x() * part.cols), 0, part.cols - 1);
      if (part(row, col) != 0) hidden(y, x) = 255;
    }
}

Mask mask_of(const Cover& cover, const BoardToPixel& to_pixel, const Frame& frame, int squares) {
  cv::Mat1b hidden(frame.image_bgr.size(), std::uint8_t{0});
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      const cv::Mat1b part = cover.samples(cv::Rect(col * patch_side, row * patch_side, patch_side, patch_side));
      if (cv::countNonZero(part) == 0) continue;
      draw_cover(part, to_pixel(col, row), to_pixel(col + 1, row), to_pixel(col, row + 1), hidden);
    }
  Mask mask;
  mask.stamp = frame.stamp;
  mask.width = static_cast<std::uint16_t>(hidden.cols);
  mask.height = static_cast<std::uint16_t>(hidden.rows);
  bool inside = false;
  std::uint32_t run = 0;
  for (int y = 0; y < hidden.rows; ++y)
    for (int x = 0; x < hidden.cols; ++x) {
      if ((hidden(y, x) != 0) != inside) {
        mask.runs.push_back(run);
        run = 0;
        inside = !inside;
      }
      ++run;
    }
  mask.runs.push_back(run);
  return mask;
}

}  // namespace

struct ObserveContext::State {
  explicit State(const ObserveOptions& given)
      : options(given), tracker(tracker_options(given)), reader(given.board.squares, given.method) {
    if (given.corners_px) tracker.start_at(points_of(*given.corners_px));
  }
  ObserveOptions options;
  BoardTracker tracker;
  PieceReader reader;
  Intrinsics intrinsics;  // the last ones told
  bool orientation_checked = false;
};

ObserveContext::ObserveContext(const ObserveOptions& options) : state_(std::make_unique<State>(options)) {}
ObserveContext::ObserveContext(ObserveContext&&) noexcept = default;
ObserveContext::~ObserveContext() = default;

void ObserveContext::restart(const std::optional<std::array<double, 8>>& corners_px) {
  state_->tracker.forget();
  state_->reader.forget();
  state_->orientation_checked = false;
  if (corners_px) state_->tracker.start_at(points_of(*corners_px));
}

void ObserveContext::read_again() {
  state_->reader.forget();
}

void ObserveContext::expect(const std::string& real_squares) {
  state_->reader.expect(real_squares);
}

Observation observe(const Frame& frame, ObserveContext& context) {
  ObserveContext::State& state = *context.state_;
  const BoardGeometry& board = state.options.board;
  Observation result;

  TrackedBoard seen =
      timed(result.step_ms, "pose", [&] { return state.tracker.track(frame.image_bgr, frame.stamp.capture_ns); });

  settle_intrinsics(board, seen, state.intrinsics);
  result.intrinsics = state.intrinsics;
  result.pose = estimate_of(seen, frame.stamp, state.intrinsics.id);
  result.debug.stamp = frame.stamp;
  if (seen.status != TrackStatus::lost)
    result.debug = debug_view(state.tracker.model(), seen.X_CB, seen.camera, seen.fit, frame.stamp);

  const bool good = seen.status == TrackStatus::ok || seen.status == TrackStatus::relocalised;
  if (!good || !state.options.read_pieces) return result;
  const BoardToPixel to_pixel = board_to_pixel(seen, board);
  const BoardView view =
      timed(result.step_ms, "view", [&] { return view_board(frame.image_bgr, board.squares, to_pixel); });
  const PieceReading reading = timed(result.step_ms, "pieces", [&] {
    std::vector<double> scan;
    if (state.options.method == ReadingMethod::scan_segments)
      scan = scan_values(build_pyramid(frame.image_bgr, 1).levels[0], board.squares, to_pixel);
    return state.reader.read(view, frame.stamp, scan);
  });
  result.debug.readings = letters_of(reading.occupancy);
  if (reading.occupancy.covered) result.mask = mask_of(reading.cover, to_pixel, frame, board.squares);
  result.occupancy = reading.occupancy;

  // Which side of the board is which cannot be told from its squares: the expected pieces tell it, once at the start
  // and when the board comes back from elsewhere.
  if (seen.either_way_round) state.orientation_checked = false;
  constexpr std::int64_t long_enough_ns = 200'000'000;
  if (!state.orientation_checked && reading.occupancy.stable_ns > long_enough_ns) {
    state.orientation_checked = true;
    if (state.reader.looks_turned_round()) {
      state.tracker.turn_round();
      state.reader.forget();
    }
  }
  return result;
}

}  // namespace counterpart
