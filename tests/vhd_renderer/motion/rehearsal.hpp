// Runs a director frame by frame and keeps what it said; what motion tests share.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "vhd_renderer/body/mannequin.hpp"
#include "vhd_renderer/motion/director.hpp"

namespace counterpart {

inline constexpr std::int64_t frame_ns = 40'000'000;

inline Scene board_with(const std::vector<std::pair<std::string, int>>& pieces) {
  Scene scene;
  scene.revision = 1;
  for (const auto& [name, square] : pieces) {
    scene.pieces.push_back({name, Side::light, false, false, centre_of_square_B(square, scene.board)});
  }
  return scene;
}

struct Rehearsal {
  explicit Rehearsal(Figure who = mannequin(), ClipLibrary clips = clip_library())
      : figure(std::move(who)), director(figure, {}, std::move(clips)) {}

  Figure figure;
  Director director;
  std::int64_t now_ns = 0;
  Performance last;
  std::map<std::uint64_t, std::vector<Feedback>> said;

  void frame(const std::vector<Command>& commands = {}, const Scene* scene = nullptr) {
    DirectorInputs in;
    in.now_ns = now_ns;
    in.commands = commands;
    in.scene = scene;
    last = director.step(in);
    now_ns += frame_ns;
    for (const Feedback& f : last.feedback) said[f.command_id].push_back(f);
  }

  bool ended(std::uint64_t id) const {
    const auto found = said.find(id);
    return found != said.end() && is_final(found->second.back().state);
  }

  void run_until_ended(std::uint64_t id, int most_frames = 800) {
    for (int i = 0; i < most_frames && !ended(id); ++i) frame();
    EXPECT_TRUE(ended(id)) << id;
  }

  Eigen::Vector3f joint(const std::string& name) const {
    for (std::size_t j = 0; j < figure.joints.size(); ++j) {
      if (figure.joints[j].name == name) return last.X_BJ[j].translation();
    }
    ADD_FAILURE() << name;
    return Eigen::Vector3f::Zero();
  }

  Eigen::Vector3f piece(const std::string& name) const {
    for (const StagedPiece& p : last.pieces) {
      if (p.name == name) return p.X_BP.translation();
    }
    ADD_FAILURE() << name;
    return Eigen::Vector3f::Zero();
  }

  // gait "instant": already there when this returns.
  void take_seat(const std::string& gait = "walk") {
    Command sit;
    sit.id = 1'000'000;
    sit.action = Navigate{"seat", {}, 0, gait};
    frame({sit});
    run_until_ended(sit.id);
  }
};

inline Command grasp(std::uint64_t id, const std::string& piece, const std::vector<Point3>& path,
                     Hand hand = Hand::any) {
  Command c;
  c.id = id;
  c.action = Grasp{piece, path, hand, "", 0};
  return c;
}

}  // namespace counterpart
