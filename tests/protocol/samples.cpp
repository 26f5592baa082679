#include "tests/protocol/samples.hpp"

namespace counterpart {
namespace {

Bytes32 counting(std::uint8_t start) {
  Bytes32 bytes{};
  for (std::uint8_t& byte : bytes) byte = start++;
  return bytes;
}

Message pose() {
  PoseEstimate pose;
  pose.stamp = {1234, 5'000'000'001};
  pose.object_id = 2;
  pose.status = TrackStatus::relocalised;
  pose.X_CB = {{0.5, -0.5, 0.5, -0.5}, {0.125, -0.25, 0.75}};
  for (std::size_t i = 0; i < pose.covariance.size(); ++i) pose.covariance[i] = static_cast<float>(i) / 64;
  pose.rms_px = 0.375F;
  pose.seen_share = 0.875F;
  pose.intrinsics_id = 9;
  return pose;
}

Message video(PixelCodec codec) {
  VideoFrame video;
  video.stamp = {77, -3};
  video.codec = codec;
  video.width = 2;
  video.height = 2;
  video.stride = codec == PixelCodec::jpeg ? 0 : 7;
  video.bytes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
  return video;
}

Message mask() {
  Mask mask;
  mask.stamp = {78, 4};
  mask.width = 4;
  mask.height = 3;
  mask.runs = {5, 2, 5};
  return mask;
}

Message debug() {
  DebugView view;
  view.stamp = {79, 5};
  view.lines = {{1, 2, 3.5F, 4}};
  view.points = {{10.25F, 20, 1}, {11, 21, 255}};
  view.readings = "edlp?";
  return view;
}

Message board_state() {
  BoardState state;
  state.revision = 12;
  state.rules = "brazilian";
  state.squares = "bbbbbbbbbbbbeeeeeeeewwwwwwwwwwWB";
  state.turn = Side::dark;
  state.virtual_side = Side::dark;
  state.phase = GamePhase::waiting_for_removal;
  state.result = GameResult::draw;
  state.moves = {"9-13", "24x15"};
  state.to_remove = {18, 19};
  state.start_fen = "W:W31:B1";
  return state;
}

Message game_event() {
  GameEvent event;
  event.id = 5;
  event.kind = EventKind::illegal_move;
  event.side = Side::dark;
  event.code = "must_capture";
  event.move = "19-23";
  event.squares = {19, 23};
  event.captured = {28};
  event.legal = {"19x28"};
  event.result = GameResult::light_wins;
  event.stamp_ns = 123456789012345;
  return event;
}

Message control() {
  Control control;
  control.id = 6;
  control.kind = ControlKind::corners;
  control.text = "by hand";
  control.number = -4;
  control.corners_px = {0.5, 1, 2, 3, 4, 5, 6, 7.25};
  return control;
}

Message scene() {
  Scene scene;
  scene.revision = 3;
  scene.board = {8, 0.05, 0.02, 0.01, 0.02, 0.01, SquareColour::light};
  scene.table_height_m = 0.75;
  scene.pieces = {{"light_31", Side::light, true, true, {0.1, -0.2, 0.3}}};
  scene.boxes = {{"table", {{1, 0, 0, 0}, {0, 0, -0.1}}, {1.5, 0.75, 0.05}}};
  scene.light = {{0, 0, 1}, {1, 0.5, 0.25}, {0.125, 0.25, 0.5}};
  scene.virtual_side = Side::dark;
  scene.opponent = "anna";
  return scene;
}

Command command(std::uint64_t id, Action action) {
  Command command;
  command.id = id;
  command.action = std::move(action);
  command.after = {1, 2};
  command.delay_ms = 10;
  command.deadline_ms = 2000;
  command.interrupt = true;
  return command;
}

Message feedback() {
  Feedback feedback;
  feedback.command_id = 18446744073709551615U;
  feedback.state = FeedbackState::failed;
  feedback.verb = "grasp";
  feedback.phase = "reach";
  feedback.code = "out_of_reach";
  feedback.gap_mm = 12.5;
  feedback.stamp_ns = -1;
  return feedback;
}

}  // namespace

std::vector<std::pair<std::string, Message>> sample_messages() {
  Hello hello{1, 3, Role::director, "client 2.0", 42, 7, true, true, true};
  Hello asking = hello;
  asking.h264 = asking.want_debug = true;
  Welcome welcome{1, 9007199254740993U, Role::renderer, "server 1.0", true, 8, true};
  Intrinsics intrinsics{4, 720, 576, 700.5, 701.25, 360, 288, {0.5, -0.25, 0.125, 0.0625, -1}};
  Navigate navigate{"seat", {{0, -1, 0}}, 1.5, "hurry"};
  Gaze gaze{GazeTarget::point, 28, "light_31", {0.5, 0.25, 0}, 2};
  return {
      {"hello", hello},
      {"hello_asking", asking},
      {"welcome", welcome},
      {"heartbeat", Heartbeat{3, 4}},
      {"error", ErrorReport{6, "another version"}},
      {"bye", Bye{"done"}},
      {"clock_request", ClockRequest{-5}},
      {"clock_response", ClockResponse{1, 2, 3}},
      {"acknowledge", Acknowledge{99}},
      {"challenge", Challenge{counting(0)}},
      {"proof", Proof{counting(1), counting(200)}},
      {"intrinsics", intrinsics},
      {"pose", pose()},
      {"video_raw", video(PixelCodec::raw_bgr8)},
      {"video_jpeg", video(PixelCodec::jpeg)},
      {"video_h264", video(PixelCodec::h264)},
      {"mask", mask()},
      {"debug", debug()},
      {"frame_done", FrameDone{{80, 6}}},
      {"board_state", board_state()},
      {"game_event", game_event()},
      {"control", control()},
      {"scene", scene()},
      {"grasp", command(10, Grasp{"light_31", {{0.1, 0.2, 0}, {0.3, 0.4, 0}}, Hand::left, "slam", 1.5})},
      {"keyframe", command(11, Keyframe{"nod", 0.5, 0.25, BodyPart::head, true})},
      {"navigate", command(12, navigate)},
      {"gaze", command(13, gaze)},
      {"say", command(14, Say{"Prends, s'il te pla\xC3\xAEt", "fr", "must_capture"})},
      {"express", command(15, Express{"doubt", 0.5, 3})},
      {"stop", command(16, Stop{{10, 11}})},
      {"feedback", feedback()},
  };
}

}  // namespace counterpart
