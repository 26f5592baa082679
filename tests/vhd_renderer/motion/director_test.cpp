#include "vhd_renderer/motion/director.hpp"

#include <map>

#include <gtest/gtest.h>

#include "vhd_renderer/body/mannequin.hpp"
#include "vhd_renderer/motion/anatomy.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t frame_ns = 40'000'000;

Scene board_with(const std::vector<std::pair<std::string, int>>& pieces) {
  Scene scene;
  scene.revision = 1;
  for (const auto& [name, square] : pieces) {
    scene.pieces.push_back({name, Side::light, false, false, centre_of_square_B(square, scene.board)});
  }
  return scene;
}

// Runs a director frame by frame and keeps what it said.
struct Rehearsal {
  Figure figure = mannequin();
  Director director{figure};
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

  void take_seat() {
    Command sit;
    sit.id = 1'000'000;
    sit.action = Navigate{"seat", {}, 0, "walk"};
    frame({sit});
    run_until_ended(sit.id);
  }
};

Command grasp(std::uint64_t id, const std::string& piece, const std::vector<Point3>& path, Hand hand = Hand::any) {
  Command c;
  c.id = id;
  c.action = Grasp{piece, path, hand, "", 0};
  return c;
}

TEST(Director, WalksInAndSitsDownWithinNineSeconds) {
  Rehearsal r;
  r.take_seat();
  EXPECT_LT(r.now_ns, 9'000'000'000);
  EXPECT_EQ(r.said[1'000'000].back().state, FeedbackState::finished);
  EXPECT_NEAR(r.joint("HumanoidRoot").x(), 0, 0.02);
  EXPECT_LT(r.joint("HumanoidRoot").y(), -0.40);
  EXPECT_GT(r.joint("HumanoidRoot").y(), -0.60);
  EXPECT_NEAR(r.joint("l_hip").z(), -0.74 + 0.53, 0.03);
}

TEST(Director, MovesAPieceAndSaysHowFarTheHandWas) {
  Rehearsal r;
  const Scene scene = board_with({{"light_32", 32}});
  r.frame({}, &scene);
  r.take_seat();
  const Point3 to = centre_of_square_B(28, scene.board);
  r.frame({grasp(1, "light_32", {to})});
  r.run_until_ended(1);
  const auto& said = r.said[1];
  ASSERT_EQ(said.back().state, FeedbackState::finished) << said.back().code;
  EXPECT_GE(said.back().gap_mm, 0);
  EXPECT_LT(said.back().gap_mm, 1);
  EXPECT_NEAR(r.piece("light_32").x(), to[0], 1e-5);
  EXPECT_NEAR(r.piece("light_32").y(), to[1], 1e-5);
  EXPECT_NEAR(r.piece("light_32").z(), 0, 1e-5);
}

TEST(Director, RefusesWhatCannotBeWithACode) {
  Rehearsal r;
  const Scene scene = board_with({{"light_32", 32}});
  r.frame({}, &scene);
  r.take_seat();
  const double nan = std::nan("");
  const Point3 to = centre_of_square_B(28, scene.board);
  std::vector<std::pair<Command, std::string>> bad;
  bad.push_back({grasp(1, "nobody", {to}), "unknown_piece"});
  bad.push_back({grasp(2, "light_32", {{nan, 0, 0}}), "not_a_number"});
  bad.push_back({grasp(3, "light_32", {{3, 3, 0}}), "out_of_reach"});
  bad.push_back({grasp(4, "light_32", {}), "no_path"});
  Command clip;
  clip.id = 5;
  clip.action = Keyframe{"fly", 1, 1, BodyPart::whole, false};
  bad.push_back({clip, "unknown_clip"});
  for (const auto& [command, code] : bad) {
    r.frame({command});
    r.run_until_ended(command.id, 3);
    EXPECT_EQ(r.said[command.id].back().state, FeedbackState::failed);
    EXPECT_EQ(r.said[command.id].back().code, code);
  }
  r.frame({grasp(6, "light_32", {to})});
  r.run_until_ended(6);
  EXPECT_EQ(r.said[6].back().state, FeedbackState::finished);
}

}  // namespace
}  // namespace counterpart
