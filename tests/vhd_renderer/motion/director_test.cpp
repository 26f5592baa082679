#include "vhd_renderer/motion/director.hpp"

#include <cmath>

#include "tests/vhd_renderer/motion/rehearsal.hpp"

namespace counterpart {
namespace {

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

TEST(Director, IsAtOnceWhereTheGaitIsInstant) {
  Rehearsal r;
  r.take_seat("instant");
  EXPECT_EQ(r.now_ns, frame_ns) << "one step";
  EXPECT_EQ(r.said[1'000'000].back().state, FeedbackState::finished);
  const Eigen::Vector3f hips = r.joint("HumanoidRoot");
  EXPECT_NEAR(hips.y(), -0.51, 0.1);
  EXPECT_NEAR(r.joint("l_hip").z(), -0.74 + 0.53, 0.03) << "he sits in the very frame";
  const Eigen::Vector3f wrist = r.joint("r_wrist");
  r.frame();
  EXPECT_LT((r.joint("HumanoidRoot") - hips).norm(), 0.005);
  EXPECT_LT((r.joint("r_wrist") - wrist).norm(), 0.01) << "the hands lie where they belong";
}

TEST(Director, PointsWithTheForefingerAtAPlaceAndHoldsThere) {
  Rehearsal r;
  r.take_seat("instant");
  const Point3 place{centre_of_square_B(23, BoardGeometry{})[0], centre_of_square_B(23, BoardGeometry{})[1], 0.05};
  Command point;
  point.id = 1;
  point.action = Grasp{"", {place}, Hand::any, "point", 0};
  r.frame({point});
  const Eigen::Vector3f target(static_cast<float>(place[0]), static_cast<float>(place[1]), 0.05F);
  int frames_there = 0;
  for (int i = 0; i < 200 && !r.ended(1); ++i) {
    r.frame();
    // The last joint of the finger is some 2.5 cm before its tip.
    const float distance = (r.joint("r_index3") - target).norm();
    const bool stretched = (r.joint("r_index1") - r.joint("r_index3")).norm() > 0.0675F;     // 0.068 straight
    const bool others_bent = (r.joint("r_middle1") - r.joint("r_middle3")).norm() < 0.058F;  // 0.073 at rest
    if (distance < 0.035F && stretched && others_bent) ++frames_there;
  }
  EXPECT_EQ(r.said[1].back().state, FeedbackState::finished) << r.said[1].back().code;
  for (const Feedback& f : r.said[1]) EXPECT_LT(f.gap_mm, 1) << f.phase;
  EXPECT_GE(r.said[1].back().gap_mm, 0);
  EXPECT_NEAR(frames_there * 0.04, 1.1, 0.3) << "seconds at the place";
}

TEST(Director, AHandThatThinksComesDownWhenThereIsSomethingToDo) {
  Rehearsal r;
  const Scene scene = board_with({{"light_32", 32}});
  r.frame({}, &scene);
  r.take_seat("instant");
  Command think;
  think.id = 1;
  think.action = Keyframe{"think", 1, 1, BodyPart::whole, true};
  r.frame({think});
  for (int i = 0; i < 50; ++i) r.frame();
  EXPECT_GT(r.joint("r_wrist").z(), 0.15) << "at the chin";
  r.frame({grasp(2, "light_32", {centre_of_square_B(28, scene.board)}, Hand::left)});
  for (int i = 0; i < 40; ++i) r.frame();
  EXPECT_EQ(r.said[1].back().state, FeedbackState::finished);
  EXPECT_LT(r.joint("r_wrist").z(), 0.08) << "on the table while the other hand carries";
  r.run_until_ended(2);
  EXPECT_EQ(r.said[2].back().state, FeedbackState::finished) << r.said[2].back().code;
}

TEST(Director, DoesNotThinkTheSameWayTwice) {
  Rehearsal r;
  r.take_seat("instant");
  std::vector<Eigen::Vector3f> right;
  std::vector<Eigen::Vector3f> left;
  for (std::uint64_t id = 1; id <= 3; ++id) {
    Command think;
    think.id = id;
    think.action = Keyframe{"think", 1, 1, BodyPart::whole, false};
    r.frame({think});
    for (int i = 0; i < 50; ++i) r.frame();
    right.push_back(r.joint("r_wrist"));
    left.push_back(r.joint("l_wrist"));
    r.run_until_ended(id);
    for (int i = 0; i < 40; ++i) r.frame();
  }
  EXPECT_GT(right[0].z(), 0.15);
  EXPECT_LT(right[1].z(), 0.08);
  EXPECT_LT(left[1].z(), 0.08);
  EXPECT_GT(left[2].z(), 0.15);
  EXPECT_LT(right[2].z(), 0.08);
}

}  // namespace
}  // namespace counterpart
