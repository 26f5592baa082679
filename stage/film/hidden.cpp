#include "stage/film/hidden.hpp"

#include <algorithm>
#include <cmath>

#include "stage/player/seated_body.hpp"
#include "stage/room/arm.hpp"

namespace counterpart::stage {
namespace {

struct Sphere {
  Eigen::Vector3f middle{0, 0, 0};
  float radius = 0;
};

// Round a capsule, with a little room.
Sphere sphere_round(const Capsule& c) {
  return {(c.a_m + c.b_m) / 2, (c.b_m - c.a_m).norm() / 2 + std::max(c.radius_a_m, c.radius_b_m) + 1e-3f};
}

bool passes_by(const Sphere& sphere, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  const Eigen::Vector3f way = to - from;
  const float nearest = std::clamp((sphere.middle - from).dot(way) / way.squaredNorm(), 0.f, 1.f);
  return (from + nearest * way - sphere.middle).squaredNorm() > sphere.radius * sphere.radius;
}

// Does the capsule come between the two points? Steps along the segment, nearer than the capsule's surface each time.
bool blocks(const Capsule& capsule, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  if (passes_by(sphere_round(capsule), from, to)) return false;
  const Eigen::Vector3f way = to - from;
  const float length = way.norm();
  float gone = 0;
  while (gone < length) {
    const float distance = distance_m(capsule, from + way * (gone / length));
    if (distance < 5e-4f) return true;
    gone += std::max(distance, 1e-3f);
  }
  return false;
}

bool behind_piece(const World& world, const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
  const Eigen::Vector3d up = eye - point;
  for (const RealPiece& piece : world.pieces) {
    const double height = world.board.piece_height_m * (piece.king ? 2 : 1);
    // The part of the line of sight between the piece's foot and its top, as a segment seen from above.
    const double low = std::clamp((piece.p_B.z() - point.z()) / up.z(), 0.0, 1.0);
    const double high = std::clamp((piece.p_B.z() + height - point.z()) / up.z(), 0.0, 1.0);
    if (high <= low && !(piece.p_B.z() <= point.z() && low == 0)) continue;
    const Eigen::Vector2d a = (point + low * up).head<2>() - piece.p_B.head<2>();
    const Eigen::Vector2d d = (high - low) * up.head<2>();
    const double t = d.squaredNorm() > 0 ? std::clamp(-a.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    if ((a + t * d).norm() < world.board.piece_radius_m) return true;
  }
  return false;
}

bool behind_sheet(const Sheet& sheet, const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
  const Eigen::Vector3d from = sheet.X_BS.inverse() * eye;
  const Eigen::Vector3d to = sheet.X_BS.inverse() * point;
  if (from.z() * to.z() >= 0) return false;  // both on one side
  const Eigen::Vector3d at = from + (to - from) * (from.z() / (from.z() - to.z()));
  return std::abs(at.x()) < sheet.size_x_m / 2 && std::abs(at.y()) < sheet.size_y_m / 2;
}

bool behind_object(const World& world, const RoomObject& object, const Eigen::Vector3d& eye,
                   const Eigen::Vector3d& point) {
  const Eigen::Isometry3d X_OB = object.X_RO.inverse() * world.X_RB;
  return comes_between(polygon_model(object.kind, object.size_m), X_OB * eye, X_OB * point);
}

bool behind_table(const World& world, const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
  PolygonModel table;
  table.blocks = {{{0, (kTableNearY_m + kTableFarY_m) / 2, -world.board.thickness_m - kTableThickness_m / 2},
                   {kTableX_m, kTableNearY_m - kTableFarY_m, kTableThickness_m}}};
  return comes_between(table, world.X_RB * eye, world.X_RB * point);
}

bool outside(const View& view, const Eigen::Vector3d& point) {
  if ((view.X_CB * point).z() <= kNear_m) return true;
  const Eigen::Vector2d at = project(view, point);
  return !(at.x() >= 0 && at.y() >= 0 && at.x() <= view.intrinsics.width - 1 && at.y() <= view.intrinsics.height - 1);
}

// Capsules near each other: most lines of sight pass by all of them.
struct Cluster {
  std::vector<Capsule> capsules;
  Sphere round;
};

std::vector<Cluster> clustered(const std::vector<Capsule>& capsules) {
  constexpr std::size_t kTogether = 6;  // neighbours in the list are neighbours in space
  std::vector<Cluster> clusters;
  for (std::size_t first = 0; first < capsules.size(); first += kTogether) {
    Cluster cluster;
    const std::size_t last = std::min(first + kTogether, capsules.size());
    for (std::size_t i = first; i < last; ++i) {
      cluster.capsules.push_back(capsules[i]);
      cluster.round.middle += sphere_round(capsules[i]).middle / static_cast<float>(last - first);
    }
    for (const Capsule& c : cluster.capsules) {
      const Sphere own = sphere_round(c);
      cluster.round.radius = std::max(cluster.round.radius, (own.middle - cluster.round.middle).norm() + own.radius);
    }
    clusters.push_back(cluster);
  }
  return clusters;
}

std::vector<Cluster> player_in(const World& world) {
  if (!world.player_present) return {};
  if (world.seated) {
    const Eigen::Isometry3f X_BR = world.X_RB.inverse().cast<float>();
    std::vector<Capsule> shape;
    for (const Capsule& c : world.seated->shape_R) shape.push_back(moved(c, X_BR));
    return clustered(shape);
  }
  return clustered(arm_capsules(arm_for(world.hand.pinch_B), static_cast<float>(world.board.piece_radius_m)));
}

bool behind_player_or_sheet(const World& world, const std::vector<Cluster>& player, const Eigen::Vector3d& eye,
                            const Eigen::Vector3d& point) {
  if (world.sheet && behind_sheet(*world.sheet, eye, point)) return true;
  const Eigen::Vector3f from = eye.cast<float>(), to = point.cast<float>();
  return std::any_of(player.begin(), player.end(), [&](const Cluster& cluster) {
    return !passes_by(cluster.round, from, to) && std::any_of(cluster.capsules.begin(), cluster.capsules.end(),
                                                              [&](const Capsule& c) { return blocks(c, from, to); });
  });
}

}  // namespace

double object_edges_hidden(const World& world, std::size_t object, const View& view) {
  constexpr int kSamples = 12;
  const RoomObject& it = world.objects[object];
  const PolygonModel model = polygon_model(it.kind, it.size_m);
  const Eigen::Isometry3d X_BO = world.X_RB.inverse() * it.X_RO;
  const Eigen::Vector3d eye = camera_position_B(view);
  const Eigen::Vector3d eye_O = X_BO.inverse() * eye;
  const std::vector<Cluster> player = player_in(world);
  double seen_m = 0, all_m = 0;
  for (const std::vector<int>& face : model.faces) {
    const auto at = [&](std::size_t i) { return model.vertices_O[static_cast<std::size_t>(face[i % face.size()])]; };
    if ((at(1) - at(0)).cross(at(2) - at(0)).dot(eye_O - at(0)) <= 0) continue;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Eigen::Vector3d way = at(i + 1) - at(i);
      for (int k = 0; k < kSamples; ++k) {
        const Eigen::Vector3d point_O = at(i) + (k + 0.5) / kSamples * way;
        const Eigen::Vector3d point = X_BO * point_O;
        bool unseen = outside(view, point) || comes_between(model, eye_O, point_O) || behind_table(world, eye, point) ||
                      behind_player_or_sheet(world, player, eye, point);
        for (std::size_t other = 0; other < world.objects.size() && !unseen; ++other) {
          unseen = other != object && behind_object(world, world.objects[other], eye, point);
        }
        all_m += way.norm();
        seen_m += unseen ? 0 : way.norm();
      }
    }
  }
  return all_m > 0 ? 1 - seen_m / all_m : 1;
}

Hidden hidden_shares(const World& world, const View& view) {
  const std::vector<Cluster> player = player_in(world);
  const Eigen::Vector3d eye = camera_position_B(view);
  const auto behind_player = [&](const Eigen::Vector3d& point) {
    return behind_player_or_sheet(world, player, eye, point);
  };
  const auto behind_objects = [&](const Eigen::Vector3d& point) {
    return std::any_of(world.objects.begin(), world.objects.end(),
                       [&](const RoomObject& object) { return behind_object(world, object, eye, point); });
  };
  const int n = world.board.squares;
  const double size = world.board.square_size_m;
  const double half = n * size / 2;
  Hidden hidden;
  for (int row = 0; row < 2 * n; ++row) {
    for (int col = 0; col < 2 * n; ++col) {
      const Eigen::Vector3d point((col + 0.5) * size / 2 - half, (row + 0.5) * size / 2 - half, 0);
      hidden.surface_by_arm += behind_player(point) ? 1.0 / (4 * n * n) : 0;
    }
  }
  constexpr int kSamplesASquare = 3;
  const int along = kSamplesASquare * n;
  for (int line = 0; line <= n; ++line) {
    for (int i = 0; i < along; ++i) {
      const double s = (i + 0.5) * 2 * half / along - half;
      const double at = line * size - half;
      for (const Eigen::Vector3d& point : {Eigen::Vector3d(s, at, 0), Eigen::Vector3d(at, s, 0)}) {
        const bool unseen =
            outside(view, point) || behind_piece(world, eye, point) || behind_player(point) || behind_objects(point);
        hidden.edges += unseen ? 1.0 / (2 * along * (n + 1)) : 0;
      }
    }
  }
  return hidden;
}

}  // namespace counterpart::stage
