// The pose that puts the model's edges on the picture's: robust Gauss-Newton on edge points searched along normals.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "protocol/vocabulary/intrinsics.hpp"
#include "tracker_server/edges/edge_search.hpp"
#include "tracker_server/edges/pyramid.hpp"
#include "tracker_server/pose/model.hpp"

namespace counterpart {

// A point of a model's edge that is looked for.
struct EdgeSample {
  Eigen::Vector3d p_M;
  Eigen::Vector3d along_M;  // unit
  int segment = 0;
  int polarity = 0;    // as ModelSegment's, or what was learned
  float contrast = 0;  // grey levels it showed so far; 0: not known
  float grey = 0;      // grey level half way up that step
};

// Evenly along each segment.
std::vector<EdgeSample> sample_edges(const Model& model, int per_segment);

// About so many in all, 3 to 60 on each segment.
std::vector<EdgeSample> sample_edges_in_all(const Model& model, std::size_t wanted);

// Samples of the edges that can be seen from this pose, by index.
std::vector<std::size_t> visible_samples(const Model& model, const std::vector<EdgeSample>& samples,
                                         const Eigen::Isometry3d& X_CM);

// One pass over the samples.
struct FitRound {
  int level = 0;       // of the pyramid
  float reach_px = 4;  // on that level
  int stride = 1;      // every so many-th sample
  int iterations = 2;
};

struct FocalPrior {
  bool estimate = false;
  double log_focal = 0;    // of fx in pixels
  double information = 0;  // 1 / variance
};

// How many of the points that were looked for found their edge.
struct HitCount {
  std::size_t searched = 0, accepted = 0;
  void add(const EdgeHit& hit) {
    add(HitCount{1, hit.verdict == EdgeVerdict::accepted ? std::size_t{1} : std::size_t{0}});
  }
  void add(const HitCount& other) {
    searched += other.searched;
    accepted += other.accepted;
  }
  bool fewer_than(double share) const { return static_cast<double>(accepted) < share * static_cast<double>(searched); }
  double share() const { return searched == 0 ? 0 : static_cast<double>(accepted) / static_cast<double>(searched); }
};

struct PoseFit {
  Eigen::Isometry3d X_CM;
  Intrinsics camera;  // the focal length may have been estimated
  // Of (translation, rotation vector, log focal), in C, rotation about the model's origin; without the prior.
  Eigen::Matrix<double, 7, 7> information;
  double rms_px = 0;
  std::size_t searched = 0;  // in the last round
  std::size_t accepted = 0;
  double share() const { return searched == 0 ? 0 : static_cast<double>(accepted) / static_cast<double>(searched); }

  // Of the last round, in step: sample index, where it was looked for, what was found.
  std::vector<std::size_t> samples;
  std::vector<EdgeProbe> probes;
  std::vector<EdgeHit> hits;
};

PoseFit fit_pose(const Pyramid& pyramid, const Model& model, const std::vector<EdgeSample>& samples,
                 const std::vector<std::size_t>& visible, const Intrinsics& camera, const Eigen::Isometry3d& start,
                 const std::vector<FitRound>& rounds, const FocalPrior& focal);

// How an edge of an object looks now: the next picture's edge there has the same side bright. What lies behind an
// outline and which faces meet in an edge change as an object turns, so nothing older is kept.
void remember_look(const EdgeHit& hit, EdgeSample& sample);

// Turned by a rotation vector about its own origin and moved, both in C.
Eigen::Isometry3d moved(const Eigen::Isometry3d& X_CM, const Eigen::Vector3d& translation,
                        const Eigen::Vector3d& rotation);

}  // namespace counterpart
