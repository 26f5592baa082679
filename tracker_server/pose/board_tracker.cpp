#include "tracker_server/pose/board_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "tracker_server/locate/lattice.hpp"
#include "tracker_server/pose/normal_equations.hpp"
#include "tracker_server/pose/plane_pose.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;

// Frames for which a prediction may stand in for a sight.
constexpr int most_coasting = 2;

// A pose counts when this share of the visible edge points found their edge, and the squares' colours agree. Random
// texture reaches about 0.1 of the one and 0.1 of the other; a board four fifths hidden has 0.2 of both.
constexpr double least_share = 0.14;
constexpr double least_support = 0.13;
constexpr double largest_rms_px = 1.6;
constexpr double most_contradicted = 0.09;
constexpr std::size_t least_points = 30;

// Without a sight of the squares the pose counts when this share of the fixtures' visible edge points found their edge.
constexpr double least_fixture_share = 0.4;
constexpr std::size_t fixture_samples = 400;

const std::vector<FitRound> usual_rounds = {{1, 6, 3, 2}, {0, 4, 2, 2}, {0, 3, 1, 2}};
const std::vector<FitRound> wide_rounds = {{2, 6, 2, 2}, {1, 8, 2, 2}, {1, 5, 2, 2}, {0, 4, 1, 2}, {0, 3, 1, 2}};
// A picture that motion has smeared must look like the reference view, smeared alike.
constexpr double least_likeness = 0.45;
constexpr std::array shutter_shares = {1.0, 0.5, 0.0};

// The slower the board goes, the sharper it is seen: a reference view is replaced by one in which it goes hardly
// faster.
constexpr double sharp_way_px = 3;
constexpr int oldest_reference = 100;  // frames: pieces move, lamps change

// Few edges, and those not where all the others say: a cover hides edges, but leaves the others in their places.
constexpr double smeared_if_fewer = 0.65, smeared_if_rms_px = 0.35, smeared_if_faster_px = 5;

const std::vector<FitRound> settle_rounds = {{1, 5, 2, 2}, {0, 5, 1, 3}, {0, 3, 1, 3}};

// A pose that was followed for so many frames is right about which side of the board is which. One of a board that is
// half out of the picture may be a quarter turn and a square off for a frame or two.
constexpr int held_for_long = 12;
// Turned further than this from where it was held, the board may as well lie the other way round: at 90 degrees both
// are as near.
constexpr double either_way_rad = 1.0;

// Squares that a pose may be brought back by, one or two at a time.
constexpr int most_steps_back = 3;

// Of the shares and supports of two poses, before one is taken for the other.
constexpr double clearly_more = 0.05;

// Of a pose that explains much less of the picture than the last one did.
constexpr double largest_doubtful_rms_px = 0.4;

constexpr int pyramid_levels = 3;

// Of one picture's word about the focal length, how much is believed: its errors are alike from frame to frame.
constexpr double focal_trust = 0.05;
constexpr double focal_memory = 0.98;

// A zoom goes on as it went: the gain of its rate belongs to that of the focal length itself, about 0.3 (an alpha-beta
// filter, critically damped). Not before the focal length is known to 5 %: until then its changes are corrections.
constexpr double zoom_rate_gain = 0.15, fastest_zoom = 0.03, known_focal_information = 1 / (0.05 * 0.05);

Matrix3d quarter_turn(int n) {
  Matrix3d turn;
  turn << 0, -1, n, 1, 0, 0, 0, 0, 1;
  return turn;
}

// The two ways round in which the squares have the right colours; the one with row 0 nearer to the picture's bottom
// first: the camera looks over the real player's shoulder, whose pieces stand on the low rows.
std::array<Matrix3d, 2> ways_round(const LocatedBoard& located, const BoardGeometry& board) {
  const int n = board.squares;
  const bool first_is_light = board.played_on == SquareColour::dark;
  const Matrix3d quarter = quarter_turn(n);
  Matrix3d H = located.H;
  if (located.first_light != first_is_light) H = (H * quarter).eval();
  Matrix3d turned = H * quarter * quarter;
  const double near = apply(H, 0.5 * n, 0).y(), far = apply(H, 0.5 * n, n).y();
  if (near < far) std::swap(H, turned);
  return {H, turned};
}

// The part of the picture that holds the model, the squares that would lie round the board, and room to search.
cv::Rect part_with(const Model& model, const BoardGeometry& board, const Intrinsics& camera, const Isometry3d& X_CB,
                   const cv::Size& picture) {
  constexpr float room_px = 24;
  const cv::Rect whole({0, 0}, picture);
  const double half = (0.5 * board.squares + 1) * board.square_size_m;
  std::vector<cv::Point2f> points;
  const auto add = [&](const Eigen::Vector3d& p_B) {
    const Eigen::Vector3d p_C = X_CB * p_B;
    if (!(p_C.z() > 1e-3)) return false;
    const Vector2d p = project(camera, p_C);
    if (!(p.cwiseAbs().maxCoeff() < 1e5)) return false;
    points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    return true;
  };
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
    if (!add({x, y, 0})) return whole;
  if (model.faces.size() > 1)  // fixtures
    for (const ModelSegment& segment : model.segments)
      if (!add(segment.a_M) || !add(segment.b_M)) return whole;
  const cv::Rect2f box = cv::boundingRect(points);
  // Whole cells of the coarsest level, so that the part's pyramid is the picture's.
  constexpr int cell = 1 << (pyramid_levels - 1);
  const cv::Point low(static_cast<int>((box.x - room_px) / cell) * cell,
                      static_cast<int>((box.y - room_px) / cell) * cell);
  const cv::Point high(static_cast<int>(box.x + box.width + room_px), static_cast<int>(box.y + box.height + room_px));
  return cv::Rect(low, high) & whole;
}

bool looks_smeared(const PoseFit& fit, double way_px) {
  const bool few = fit.share() < smeared_if_fewer;
  const bool out_of_place = fit.rms_px > smeared_if_rms_px;
  return way_px > smeared_if_faster_px ? few || out_of_place : few && out_of_place;
}

void put_into_whole_picture(const PictureView& view, PoseFit& fit) {
  fit.camera = view.camera_of_whole(fit.camera);
  for (EdgeProbe& probe : fit.probes) {
    probe.x += static_cast<float>(view.part.x);
    probe.y += static_cast<float>(view.part.y);
  }
}

double angle_between(const Isometry3d& a, const Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

}  // namespace

BoardTracker::BoardTracker(const BoardTrackerOptions& options)
    : options_(options),
      model_(board_model(options.board)),
      samples_(sample_edges(model_, 4)),
      board_samples_(samples_.size()),
      motion_(options.predictor) {
  if (!options.fixtures.empty()) {
    const Model fixtures = joined_model(options.fixtures);
    for (EdgeSample sample : sample_edges_in_all(fixtures, fixture_samples)) {
      sample.segment += static_cast<int>(model_.segments.size());
      samples_.push_back(sample);
    }
    model_ = joined_model({{model_}, {fixtures}});
  }
  if (options.camera) {
    camera_ = *options.camera;
    focal_.log_focal = std::log(camera_.fx);
    focal_.information = 1 / (0.2 * 0.2);
  }
  focal_.estimate = !options.camera || options.focal == FocalMode::estimate;
  if (options.estimate_lens) lens_.emplace(options.board);
}

void BoardTracker::start_at(const Isometry3d& X_CB) {
  forget();
  start_X_CB_ = X_CB;
}

void BoardTracker::start_at(const std::array<Vector2d, 4>& corners_px) {
  forget();
  start_corners_ = corners_px;
}

void BoardTracker::forget() {
  tracking_ = false;
  frames_unseen_ = 0;
  last_X_CB_.reset();
  held_X_CB_.reset();
  frames_held_ = 0;
  start_X_CB_.reset();
  start_corners_.reset();
  motion_.forget();
  reference_.reset();
  ever_seen_ = false;
  forget_looks();
}

void BoardTracker::predict_zoom() {
  if (!focal_.estimate || !tracking_) return;
  focal_.log_focal += zoom_rate_;
  camera_.fx *= std::exp(zoom_rate_);
  camera_.fy *= std::exp(zoom_rate_);
}

// How bright the edges were; while the board is out of sight lamps and pieces may change.
void BoardTracker::forget_looks() {
  contrast_ = 0;
  last_support_ = 0;
  for (EdgeSample& sample : samples_) {
    const ModelSegment& segment = model_.segments[static_cast<std::size_t>(sample.segment)];
    sample.polarity = segment.polarity;
    sample.contrast = 0;
    sample.grey = 0;
  }
}

void BoardTracker::turn_round() {
  if (!last_X_CB_) return;
  const Isometry3d X_CB = *last_X_CB_ * Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitZ());
  const double contrast = contrast_;
  const bool tracking = tracking_;
  forget();
  last_X_CB_ = X_CB;
  held_X_CB_ = X_CB;
  contrast_ = contrast;
  tracking_ = tracking;
  ever_seen_ = true;
  start_X_CB_ = X_CB;
}

BoardTracker::Attempt BoardTracker::attempt(const PictureView& view, const Isometry3d& start,
                                            const std::vector<FitRound>& rounds) const {
  Attempt result;
  result.view = view;
  const auto visible = visible_samples(model_, samples_, start);
  const Intrinsics camera = view.camera_of_part(camera_);
  if (options_.optimizer.gradient_image) {
    const Isometry3d X_CB = fit_to_gradient(view.pyramid, samples_, visible, camera, start, options_.optimizer);
    result.fit = judge_pose(view.pyramid, model_, samples_, visible, camera, X_CB);
  } else {
    result.fit = fit_pose(view.pyramid, model_, samples_, visible, camera, start, rounds, focal_);
  }
  if (!result.fit.X_CM.matrix().allFinite() || result.fit.X_CM.translation().z() <= 0) return result;
  result.check = check_chequer(view.pyramid.levels[0], options_.board, result.fit.camera, result.fit.X_CM, contrast_);
  put_into_whole_picture(view, result.fit);
  const bool from_above = (result.fit.X_CM.inverse().translation()).z() > 0;
  const bool supported = result.check.support >= least_support || held_by_fixtures(result.fit);
  result.good = from_above && result.fit.accepted >= least_points && result.fit.share() >= least_share &&
                result.fit.rms_px <= largest_rms_px && supported && result.check.contradicted <= most_contradicted &&
                !result.check.shifted();
  return result;
}

bool BoardTracker::held_by_fixtures(const PoseFit& fit) const {
  HitCount count;
  for (std::size_t i = 0; i < fit.hits.size(); ++i)
    if (fit.samples[i] >= board_samples_) count.add(fit.hits[i]);
  return count.accepted >= least_points && !count.fewer_than(least_fixture_share);
}

std::optional<BoardTracker::Attempt> BoardTracker::from_located(const LocatedBoard& located, const PictureView& view) {
  const int width = view.part.width, height = view.part.height;  // the whole picture's
  std::optional<PlanePose> chosen;
  for (const Matrix3d& H : ways_round(located, options_.board)) {
    const bool known = options_.camera.has_value() || ever_seen_;
    const PlanePose pose =
        known ? pose_of_board(H, options_.board, camera_) : pose_and_focal_of_board(H, options_.board, width, height);
    // Once seen, the board is taken to lie as it lay.
    if (chosen && (!held_X_CB_ || angle_between(pose.X_CB, *held_X_CB_) >= angle_between(chosen->X_CB, *held_X_CB_)))
      continue;
    chosen = pose;
  }
  if (!chosen) return std::nullopt;
  if (!options_.camera && !ever_seen_) {
    camera_ = chosen->camera;
    focal_.log_focal = std::log(camera_.fx);
    // One sight from above says little; the frames to come will say more.
    focal_.information = 1 / (0.3 * 0.3);
  }
  Attempt result = attempt(view, chosen->X_CB, settle_rounds);
  if (!result.good) return std::nullopt;
  result.either_way_round = held_X_CB_ && angle_between(chosen->X_CB, *held_X_CB_) > either_way_rad;
  return result;
}

std::optional<BoardTracker::Attempt> BoardTracker::find(const cv::Mat& picture_bgr, const PictureView& view) {
  // A start that was given is tried on one picture; if it does not fit, the board is sought like any other.
  if (const auto start = std::exchange(start_X_CB_, std::nullopt)) {
    Attempt result = attempt(view, *start, wide_rounds);
    if (result.good) return result;
  }
  if (const auto corners = std::exchange(start_corners_, std::nullopt)) {
    if (const auto board = board_at_corners(view.pyramid, *corners, options_.board.squares))
      if (auto result = from_located(*board, view)) return result;
  }
  const auto located = locate_board(picture_bgr, options_.board.squares);
  if (!located) return std::nullopt;
  return from_located(*located, view);
}

void BoardTracker::learn(const Attempt& attempt) {
  constexpr float rate = 0.1F;
  // A piece that moved or a lamp changes how an edge looks where it is; what lies over the board shows edges anywhere.
  constexpr float rate_if_changed = 0.05F, where_it_is_px = 0.8F;
  for (std::size_t i = 0; i < attempt.fit.hits.size(); ++i) {
    const EdgeHit& hit = attempt.fit.hits[i];
    if (attempt.fit.samples[i] >= board_samples_) {
      remember_look(hit, samples_[attempt.fit.samples[i]]);
      continue;
    }
    const bool changed = hit.verdict == EdgeVerdict::wrong_contrast && std::abs(hit.distance) < where_it_is_px;
    if (hit.verdict != EdgeVerdict::accepted && !changed) continue;
    EdgeSample& sample = samples_[attempt.fit.samples[i]];
    const float seen = std::abs(hit.contrast);
    const float step = sample.contrast > 0 ? (changed ? rate_if_changed : rate) : 1;
    sample.contrast += step * (seen - sample.contrast);
    sample.grey += step * (hit.grey - sample.grey);
    if (sample.polarity == 0 && hit.verdict == EdgeVerdict::accepted) sample.polarity = hit.contrast > 0 ? 1 : -1;
  }
  const double seen = attempt.check.contrast;
  if (attempt.check.support > 0.5) contrast_ = contrast_ > 0 ? contrast_ + rate * (seen - contrast_) : seen;
}

void BoardTracker::accept(const Attempt& attempt, std::int64_t time_ns) {
  keep_reference(attempt);
  camera_ = attempt.fit.camera;
  if (focal_.estimate && !attempt.smeared) {
    // What this picture alone says of the focal length once the pose is free to follow.
    const Eigen::Matrix<double, 6, 6> P = attempt.fit.information.topLeftCorner<6, 6>();
    const Eigen::Matrix<double, 6, 1> c = attempt.fit.information.col(6).head<6>();
    const double own = attempt.fit.information(6, 6) - c.dot(Eigen::Matrix<double, 6, 1>(solve_normal(P, c)));
    const double innovation = std::log(camera_.fx) - focal_.log_focal;
    if (focal_.information > known_focal_information)
      zoom_rate_ = std::clamp(zoom_rate_ + zoom_rate_gain * innovation, -fastest_zoom, fastest_zoom);
    focal_.log_focal = std::log(camera_.fx);
    focal_.information = focal_memory * focal_.information + focal_trust * std::max(0.0, own);
  }
  last_X_CB_ = attempt.fit.X_CM;
  if (!held_X_CB_ || ++frames_held_ >= held_for_long) held_X_CB_ = attempt.fit.X_CM;
  last_support_ = attempt.check.support;
  motion_.add(attempt.fit.X_CM, time_ns);
  if (!attempt.smeared) learn(attempt);
  tracking_ = true;
  ever_seen_ = true;
  frames_unseen_ = 0;
  start_X_CB_.reset();
  start_corners_.reset();
}

// The camera is another one than was thought; the pose follows in the next picture.
void BoardTracker::adopt(const Calibration& calibration) {
  const std::uint32_t id = camera_.id;
  camera_ = calibration.camera;
  camera_.id = id;
  focal_.log_focal = std::log(camera_.fx);
  focal_.information = 1 / std::pow(std::max(1e-4, calibration.focal_sigma_px / camera_.fx), 2);
  zoom_rate_ = 0;
  motion_.forget();
  motion_.add(*last_X_CB_, 0);
}

// Hands come over a board within a few frames, but seldom within one: a pose that explains much less of the picture
// than the last one did may lie a few squares off.
bool BoardTracker::doubtful(const Attempt& attempt) const {
  return attempt.check.support < 0.7 * last_support_ && !held_by_fixtures(attempt.fit);
}

// The best of the poses that lie by a square or two where the board seems to go on.
std::optional<BoardTracker::Attempt> BoardTracker::one_step_back(const PictureView& view,
                                                                 const Attempt& attempt) const {
  std::optional<Attempt> best;
  for (const Eigen::Vector2i& way : attempt.check.ways_back()) {
    const Vector2d way_m = options_.board.square_size_m * way.cast<double>();
    Attempt tried =
        this->attempt(view, attempt.fit.X_CM * Eigen::Translation3d(way_m.x(), way_m.y(), 0), settle_rounds);
    if (!best || tried.check.support > best->check.support) best = std::move(tried);
  }
  return best;
}

// A pose a few squares off shows on which side the board goes on: it is tried there.
BoardTracker::Attempt BoardTracker::brought_back(const PictureView& view, Attempt attempt) const {
  for (int step = 0; step < most_steps_back && !attempt.good && attempt.check.shifted(); ++step) {
    auto tried = one_step_back(view, attempt);
    if (!tried || tried->check.support <= attempt.check.support) break;
    attempt = *std::move(tried);
  }
  // Where the picture ends before the board does, only the outline tells a side that is missing from one that is
  // covered.
  if (attempt.good && attempt.check.may_be_shifted()) {
    auto tried = one_step_back(view, attempt);
    if (tried && tried->good && tried->check.support > attempt.check.support + clearly_more &&
        outline_share(tried->fit) > outline_share(attempt.fit) + clearly_more)
      return *std::move(tried);
  }
  return attempt;
}

double BoardTracker::outline_share(const PoseFit& fit) const {
  HitCount count;
  for (std::size_t i = 0; i < fit.hits.size(); ++i) {
    const EdgeSample& sample = samples_[fit.samples[i]];
    const bool outline = model_.segments[static_cast<std::size_t>(sample.segment)].outline;
    if (outline && fit.hits[i].verdict != EdgeVerdict::outside) count.add(fit.hits[i]);
  }
  return count.share();
}

// The usual case: the board is where it should be by now. Nothing if that is not beyond doubt.
std::optional<BoardTracker::Attempt> BoardTracker::follow_nearby(const cv::Mat& picture_bgr,
                                                                 std::int64_t time_ns) const {
  const Isometry3d predicted = motion_.predict(time_ns);
  const cv::Rect part = part_with(model_, options_.board, camera_, predicted, picture_bgr.size());
  if (part.empty()) return std::nullopt;
  const PictureView view = view_of(picture_bgr, part, pyramid_levels);
  Attempt tried = attempt(view, predicted, usual_rounds);
  if (!tried.good || doubtful(tried) || tried.check.may_be_shifted() ||
      looks_smeared(tried.fit, way_px(tried.fit.X_CM)))
    return std::nullopt;
  return tried;
}

// From where the board should be by now; the pose that explains the picture best, if none is beyond doubt.
BoardTracker::Attempt BoardTracker::follow(const PictureView& view, std::int64_t time_ns) const {
  const Isometry3d predicted = motion_.predict(time_ns);
  const Isometry3d bent = motion_.predict(time_ns, Predictor::second);
  const std::pair<const Isometry3d*, const std::vector<FitRound>*> starts[] = {{&predicted, &usual_rounds},
                                                                               {&bent, &usual_rounds},
                                                                               {&predicted, &wide_rounds},
                                                                               {&bent, &wide_rounds},
                                                                               {&*last_X_CB_, &wide_rounds}};
  std::optional<Attempt> best;
  for (const auto& [start, rounds] : starts) {
    Attempt tried = brought_back(view, attempt(view, *start, *rounds));
    const auto rank = [](const Attempt& a) { return std::pair(a.good, a.check.support); };
    if (!best || rank(tried) > rank(*best)) best = std::move(tried);
    if (best->good && !doubtful(*best)) break;
  }
  return *std::move(best);
}

// How far the middle of the board has gone since the last picture, pixels.
double BoardTracker::way_px(const Isometry3d& X_CB) const {
  if (!last_X_CB_) return 0;
  return (project(camera_, X_CB.translation()) - project(camera_, last_X_CB_->translation())).norm();
}

// Where the edges are few and out of place, motion may have smeared them: whichever pose looks most like the reference
// view.
BoardTracker::Attempt BoardTracker::follow_smeared(const PictureView& view, std::int64_t time_ns, Attempt sharp) const {
  if (!reference_ || (sharp.good && !looks_smeared(sharp.fit, way_px(sharp.fit.X_CM)))) return sharp;
  std::optional<ReferenceFit> best;
  double shutter_share = 0;
  const auto try_from = [&](const Isometry3d& start, double share) {
    const MotionBlur blur{motion_.before_last(), *last_X_CB_, start, share};
    const auto fit =
        fit_to_reference(view.pyramid, view.camera_of_part(camera_), *reference_, options_.board, start, blur);
    if (!fit || (best && fit->likeness <= best->likeness)) return;
    best = fit;
    shutter_share = share;
  };
  for (const double share : shutter_shares) try_from(motion_.predict(time_ns), share);
  if (sharp.good) try_from(sharp.fit.X_CM, 0);
  if (best && shutter_share == 0 && sharp.good) return sharp;  // without blur, edges are the more exact
  const double share = best ? shutter_share : 1;
  try_from(motion_.predict(time_ns, Predictor::second), share);
  if (sharp.good) try_from(sharp.fit.X_CM, share);
  if (!best || best->likeness < least_likeness) return sharp;
  Attempt smeared = aligned(view, *best);
  return smeared.good ? smeared : sharp;
}

BoardTracker::Attempt BoardTracker::aligned(const PictureView& view, const ReferenceFit& found) const {
  Attempt result;
  result.view = view;
  result.smeared = true;
  const Intrinsics camera = view.camera_of_part(camera_);
  const auto visible = visible_samples(model_, samples_, found.X_CB);
  result.fit = judge_pose(view.pyramid, model_, samples_, visible, camera, found.X_CB);
  result.fit.information.setZero();
  result.fit.information.topLeftCorner<6, 6>() = found.information;
  result.fit.searched = found.searched;
  result.fit.accepted = found.agreeing;
  result.fit.rms_px = found.rms_px;
  put_into_whole_picture(view, result.fit);
  // What is smeared has less contrast: measured by its own.
  result.check = check_chequer(view.pyramid.levels[0], options_.board, camera, found.X_CB, 0);
  const bool from_above = found.X_CB.inverse().translation().z() > 0;
  result.good = from_above && result.check.support >= least_support && !result.check.shifted();
  return result;
}

// The picture about to be accepted, if the board is seen as sharply in it as in the reference view.
void BoardTracker::keep_reference(const Attempt& attempt) {
  if (attempt.smeared) return;
  const double way = tracking_ ? way_px(attempt.fit.X_CM) : std::numeric_limits<double>::infinity();
  if (reference_ && ++reference_age_ < oldest_reference && way > std::max(sharp_way_px, reference_way_px_)) return;
  reference_ = ReferenceView{attempt.view.pyramid, attempt.view.camera_of_part(attempt.fit.camera), attempt.fit.X_CM};
  reference_way_px_ = way;
  reference_age_ = 0;
}

// A lamp that goes on or off, or a camera that adapts, changes all edges alike. Returns whether anything changed.
bool BoardTracker::follow_light(const PoseFit& fit) {
  std::vector<float> ratios;
  for (std::size_t i = 0; i < fit.hits.size(); ++i) {
    const EdgeSample& known = samples_[fit.samples[i]];
    if (known.grey > 0 && fit.hits[i].grey > 0) ratios.push_back(fit.hits[i].grey / known.grey);
  }
  if (ratios.size() < least_points) return false;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  if (std::abs(std::log(*middle)) < 0.05F) return false;
  for (EdgeSample& sample : samples_) {
    sample.grey *= *middle;
    sample.contrast *= *middle;
  }
  contrast_ *= *middle;
  return true;
}

TrackedBoard BoardTracker::track(const cv::Mat& picture_bgr, std::int64_t time_ns) {
  const int width = picture_bgr.cols, height = picture_bgr.rows;
  if (!options_.camera && ever_seen_ && (camera_.width != width || camera_.height != height)) forget();
  std::optional<PictureView> whole;
  const auto whole_view = [&]() -> const PictureView& {
    if (!whole) whole = view_of(picture_bgr, {0, 0, width, height}, pyramid_levels);
    return *whole;
  };

  TrackedBoard result;
  const bool was_tracking = tracking_;
  std::optional<Attempt> found;
  if (tracking_ && !start_X_CB_) {
    predict_zoom();
    found = follow_nearby(picture_bgr, time_ns);
  }
  if (!found && tracking_ && !start_X_CB_) {
    Attempt tried = follow(whole_view(), time_ns);
    if (!tried.good && follow_light(tried.fit)) tried = follow(whole_view(), time_ns);
    tried = follow_smeared(whole_view(), time_ns, std::move(tried));
    result.fit = tried.fit;
    result.check = tried.check;
    if (tried.good) found = std::move(tried);
  }
  bool relocated = false;
  if (found && doubtful(*found) && found->fit.rms_px > largest_doubtful_rms_px) found.reset();
  if (!found || doubtful(*found)) {
    auto anew = find(picture_bgr, whole_view());
    if (anew && (!found || anew->check.support > found->check.support + 0.1)) {
      found = std::move(anew);
      relocated = true;
    }
  }
  if (found) {
    if (relocated) {
      motion_.forget();
      zoom_rate_ = 0;
      frames_held_ = 0;
    }
    accept(*found, time_ns);
    result.status = relocated && !was_tracking ? TrackStatus::relocalised : TrackStatus::ok;
    result.X_CB = found->fit.X_CM;
    result.camera = found->fit.camera;
    result.fit = std::move(found->fit);
    result.check = found->check;
    result.either_way_round = found->either_way_round;
    if (lens_)
      if (const auto calibration = lens_->add(picture_bgr, camera_, result.X_CB)) adopt(*calibration);
    return result;
  }
  ++frames_unseen_;
  zoom_rate_ = 0;
  result.camera = camera_;
  if (tracking_ && frames_unseen_ <= most_coasting) {
    result.status = TrackStatus::coasting;
    result.X_CB = motion_.predict(time_ns);
    return result;
  }
  tracking_ = false;
  motion_.forget();
  forget_looks();
  result.status = TrackStatus::lost;
  return result;
}

}  // namespace counterpart
