#include "tracker_server/pose/fit.hpp"

#include <algorithm>
#include <cmath>

#include "tracker_server/pose/normal_equations.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

constexpr float least_contrast = 8;  // grey levels, of a step that counts as an edge
// Of the contrast an edge showed before; less or more is something else, and so is one much brighter or darker.
constexpr float weakest_share = 0.35F, strongest_share = 2;
constexpr float largest_shift = 0.35F, always_allowed = 8;  // share of the contrast, and grey levels
constexpr double nearest_m = 1e-3;                          // in front of the camera

// Standard deviation of one edge point, pixels: noise, paper that is not flat, a lens that is not ideal.
constexpr double edge_sigma_px = 0.35;

struct Active {
  std::size_t sample;
  Vector3d p_C;
};

// Projects the samples of this round; those behind the camera or seen end-on are left out.
void aim(const std::vector<EdgeSample>& samples, const std::vector<std::size_t>& visible, const Intrinsics& camera,
         const Isometry3d& X_CM, const FitRound& round, PoseFit& fit) {
  fit.samples.clear();
  fit.probes.clear();
  for (std::size_t i = 0; i < visible.size(); i += static_cast<std::size_t>(round.stride)) {
    const EdgeSample& sample = samples[visible[i]];
    const Vector3d p_C = X_CM * sample.p_M;
    if (!(p_C.z() > nearest_m)) continue;
    const Vector3d q_C = p_C + 1e-3 * p_C.z() * (X_CM.linear() * sample.along_M);
    if (!(q_C.z() > nearest_m)) continue;
    const Vector2d p = project(camera, p_C);
    const Vector2d along = project(camera, q_C) - p;
    const double length = along.norm();
    if (!(length > 1e-3)) continue;
    EdgeProbe probe;
    probe.x = Pyramid::to_level(static_cast<float>(p.x()), round.level);
    probe.y = Pyramid::to_level(static_cast<float>(p.y()), round.level);
    probe.nx = static_cast<float>(-along.y() / length);
    probe.ny = static_cast<float>(along.x() / length);
    probe.polarity = static_cast<std::int8_t>(sample.polarity);
    probe.contrast = sample.contrast;
    fit.samples.push_back(visible[i]);
    fit.probes.push_back(probe);
  }
  fit.hits.assign(fit.probes.size(), {});
}

// One Gauss-Newton step on the edges found; residuals in pixels of the full picture. Returns false if it cannot be
// made.
bool improve(const std::vector<EdgeSample>& samples, const FitRound& round, double tukey_px, const FocalPrior& focal,
             PoseFit& fit) {
  const double scale = 1 << round.level;
  Matrix7 A = Matrix7::Zero();
  Vector7 b = Vector7::Zero();
  double squares = 0, weights = 0;
  std::size_t used = 0;
  const Vector3d origin = fit.X_CM.translation();
  for (std::size_t i = 0; i < fit.hits.size(); ++i) {
    EdgeHit& hit = fit.hits[i];
    if (hit.verdict != EdgeVerdict::accepted && hit.verdict != EdgeVerdict::outlier) continue;
    const EdgeProbe& probe = fit.probes[i];
    const Vector3d r_C = fit.X_CM.linear() * samples[fit.samples[i]].p_M;
    const Vector3d p_C = r_C + origin;
    if (!(p_C.z() > nearest_m)) continue;
    const Vector2d pixel = project(fit.camera, p_C);
    const double nx = probe.nx, ny = probe.ny;
    const double x = (probe.x + 0.5) * scale - 0.5, y = (probe.y + 0.5) * scale - 0.5;
    const double residual = hit.distance * scale - (nx * (pixel.x() - x) + ny * (pixel.y() - y));
    const double ratio = residual / tukey_px;
    if (std::abs(ratio) >= 1) {
      hit.verdict = EdgeVerdict::outlier;
      continue;
    }
    hit.verdict = EdgeVerdict::accepted;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    const double a = nx * fit.camera.fx / p_C.z(), c = ny * fit.camera.fy / p_C.z();
    const Vector3d g(a, c, -(a * p_C.x() + c * p_C.y()) / p_C.z());  // of the residual's model side by p_C
    Vector7 J;
    J.head<3>() = g;
    J.segment<3>(3) = r_C.cross(g);
    J(6) = nx * (pixel.x() - fit.camera.cx) + ny * (pixel.y() - fit.camera.cy);
    A.noalias() += (weight * J) * J.transpose();
    b += (weight * residual) * J;
    squares += weight * residual * residual;
    weights += weight;
    ++used;
  }
  fit.accepted = used;
  fit.rms_px = weights > 0 ? std::sqrt(squares / weights) : 0;
  if (used < 8) return false;
  const double sigma = std::max(edge_sigma_px, fit.rms_px);
  fit.information = A / (sigma * sigma);

  Matrix7 normal = fit.information;
  Vector7 right = b / (sigma * sigma);
  if (focal.estimate) {
    normal(6, 6) += focal.information;
    right(6) += focal.information * (focal.log_focal - std::log(fit.camera.fx));
  } else {
    normal.row(6).setZero();
    normal.col(6).setZero();
    normal(6, 6) = 1;
    right(6) = 0;
  }
  // Scaled, so that one decomposition serves metres, radians and logarithms.
  const Vector7 scaling = normal.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  Matrix7 scaled = scaling.asDiagonal() * normal * scaling.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Vector7 step = scaling.cwiseProduct(Vector7(solve_normal(scaled, Vector7(scaling.cwiseProduct(right)))));
  if (!step.allFinite()) return false;
  fit.X_CM = moved(fit.X_CM, step.head<3>(), step.segment<3>(3));
  if (focal.estimate) {
    const double factor = std::exp(std::clamp(step(6), -0.3, 0.3));
    fit.camera.fx *= factor;
    fit.camera.fy *= factor;
  }
  return true;
}

void judge_contrast(const std::vector<EdgeSample>& samples, PoseFit& fit) {
  for (std::size_t i = 0; i < fit.hits.size(); ++i) {
    const EdgeSample& known = samples[fit.samples[i]];
    EdgeHit& hit = fit.hits[i];
    if (hit.verdict != EdgeVerdict::accepted || !(known.contrast > 0)) continue;
    const float strength = std::abs(hit.contrast);
    const bool as_strong =
        strength >= weakest_share * known.contrast && strength <= strongest_share * known.contrast + always_allowed;
    const bool as_bright = std::abs(hit.grey - known.grey) <= largest_shift * known.contrast + always_allowed;
    if (!as_strong || !as_bright) hit.verdict = EdgeVerdict::wrong_contrast;
  }
}

// What lies over an edge shows edges of its own here and there, but seldom all along a stretch of it, nor along the
// segments beside it.
void judge_company(const Model& model, const std::vector<EdgeSample>& samples, PoseFit& fit) {
  constexpr std::size_t company = 3, stretch = 4;  // neighbouring points; so many vouch for each other
  constexpr double least_own = 0.5, least_beside = 0.33;
  std::vector<HitCount> counts(model.segments.size());
  const auto segment_of = [&](std::size_t i) { return static_cast<std::size_t>(samples[fit.samples[i]].segment); };
  for (std::size_t i = 0; i < fit.hits.size(); ++i) counts[segment_of(i)].add(fit.hits[i]);
  for (std::size_t first = 0, end = 0; first < fit.hits.size(); first = end) {
    const std::size_t segment = segment_of(first);
    HitCount own;
    for (end = first; end < fit.hits.size() && end < first + stretch && segment_of(end) == segment; ++end)
      own.add(fit.hits[end]);
    HitCount around = counts[segment];
    if (!model.beside.empty())
      for (const int other : model.beside[segment]) around.add(counts[static_cast<std::size_t>(other)]);
    const bool alone = (own.searched >= company && own.fewer_than(least_own)) ||
                       (around.searched >= company && around.fewer_than(least_beside));
    for (std::size_t i = first; alone && i < end; ++i)
      if (fit.hits[i].verdict == EdgeVerdict::accepted) fit.hits[i].verdict = EdgeVerdict::lonely;
  }
}

}  // namespace

Isometry3d moved(const Isometry3d& X_CM, const Vector3d& translation, const Vector3d& rotation) {
  Isometry3d result = X_CM;
  const double angle = rotation.norm();
  if (angle > 1e-15)
    result.linear() =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle) * X_CM.linear()).normalized().toRotationMatrix();
  result.translation() += translation;
  return result;
}

std::vector<EdgeSample> sample_edges(const Model& model, int per_segment) {
  std::vector<EdgeSample> samples;
  for (std::size_t s = 0; s < model.segments.size(); ++s) {
    const ModelSegment& segment = model.segments[s];
    const Vector3d whole = segment.b_M - segment.a_M;
    const double length = whole.norm();
    if (!(length > 0)) continue;
    // Not at the ends, where other edges meet this one.
    for (int i = 0; i < per_segment; ++i) {
      const double place = 0.12 + 0.76 * (per_segment == 1 ? 0.5 : static_cast<double>(i) / (per_segment - 1));
      samples.push_back({segment.a_M + place * whole, whole / length, static_cast<int>(s), segment.polarity, 0});
    }
  }
  return samples;
}

std::vector<EdgeSample> sample_edges_in_all(const Model& model, std::size_t wanted) {
  const std::size_t per_segment = wanted / std::max<std::size_t>(1, model.segments.size());
  return sample_edges(model, static_cast<int>(std::clamp<std::size_t>(per_segment, 3, 60)));
}

std::vector<std::size_t> visible_samples(const Model& model, const std::vector<EdgeSample>& samples,
                                         const Isometry3d& X_CM) {
  const Vector3d eye_M = X_CM.inverse().translation();
  std::vector<char> front(model.faces.size());
  for (std::size_t i = 0; i < front.size(); ++i)
    front[i] = model.faces[i].normal_M.dot(eye_M - model.faces[i].corners_M[0]) > 0;
  const auto faces_us = [&](int face) { return face >= 0 && front[static_cast<std::size_t>(face)]; };

  // A point is hidden if the line to the eye passes through another face that looks at us.
  const auto hidden = [&](const Vector3d& p_M, int face0, int face1) {
    const Vector3d ray = eye_M - p_M;
    for (std::size_t i = 0; i < front.size(); ++i) {
      if (!front[i] || static_cast<int>(i) == face0 || static_cast<int>(i) == face1) continue;
      const ModelFace& face = model.faces[i];
      const double slope = face.normal_M.dot(ray);
      if (!(std::abs(slope) > 1e-12)) continue;
      const double t = face.normal_M.dot(face.corners_M[0] - p_M) / slope;
      if (!(t > 1e-4 && t < 1)) continue;
      const Vector3d hit = p_M + t * ray;
      bool inside = true;
      for (std::size_t k = 0; k < face.corners_M.size() && inside; ++k) {
        const Vector3d& a = face.corners_M[k];
        const Vector3d& b = face.corners_M[(k + 1) % face.corners_M.size()];
        inside = (b - a).cross(hit - a).dot(face.normal_M) >= 0;
      }
      if (inside) return true;
    }
    return false;
  };

  std::vector<std::size_t> visible;
  visible.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ModelSegment& segment = model.segments[static_cast<std::size_t>(samples[i].segment)];
    const bool bare = segment.face0 < 0 && segment.face1 < 0;
    if (!bare && !faces_us(segment.face0) && !faces_us(segment.face1)) continue;
    if (model.faces.size() > 1 && hidden(samples[i].p_M, segment.face0, segment.face1)) continue;
    visible.push_back(i);
  }
  return visible;
}

void remember_look(const EdgeHit& hit, EdgeSample& sample) {
  const bool seen = hit.verdict == EdgeVerdict::accepted;
  sample.polarity = !seen ? 0 : hit.contrast > 0 ? 1 : -1;
  sample.contrast = seen ? std::abs(hit.contrast) : 0;
  sample.grey = seen ? hit.grey : 0;
}

PoseFit fit_pose(const Pyramid& pyramid, const Model& model, const std::vector<EdgeSample>& samples,
                 const std::vector<std::size_t>& visible, const Intrinsics& camera, const Isometry3d& start,
                 const std::vector<FitRound>& rounds, const FocalPrior& focal) {
  PoseFit fit;
  fit.X_CM = start;
  fit.camera = camera;
  fit.information.setZero();
  for (FitRound round : rounds) {
    round.level = std::min(round.level, static_cast<int>(pyramid.levels.size()) - 1);
    aim(samples, visible, fit.camera, fit.X_CM, round, fit);
    search_edges(pyramid.levels[static_cast<std::size_t>(round.level)], fit.probes, {round.reach_px, least_contrast},
                 fit.hits);
    judge_contrast(samples, fit);
    judge_company(model, samples, fit);
    fit.searched = fit.probes.size();
    const double reach_px = round.reach_px * static_cast<float>(1 << round.level);
    for (int i = 0; i < round.iterations; ++i) {
      // The first step takes in all that was found, the later ones only what agrees.
      const double tukey_px = std::max(1.5, (i == 0 ? 1.2 : 0.5) * reach_px);
      if (!improve(samples, round, tukey_px, focal, fit)) return fit;
    }
  }
  return fit;
}

}  // namespace counterpart
