#include "tracker_server/pipeline/serve.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "protocol/daemon/step_times.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "tracker_server/pipeline/audience.hpp"
#include "tracker_server/pipeline/pose_log.hpp"
#include "tracker_server/pipeline/real_pieces.hpp"
#include "tracker_server/pipeline/saved_game.hpp"
#include "tracker_server/pipeline/show_activity.hpp"

namespace counterpart {
namespace {

// From decoded picture to pose: everything before the pieces are read.
double pose_ms(const Observation& observation) {
  const auto found = observation.step_ms.find("pose");
  return found == observation.step_ms.end() ? 0 : found->second;
}

constexpr std::int64_t kWaitNs = 100'000'000;  // how often a waiting daemon looks for Ctrl-C

// One run of the daemon: what its steps share.
class Server {
 public:
  Server(const ServeOptions& options, std::unique_ptr<Camera> camera, std::unique_ptr<Endpoint> link, Game game,
         std::unique_ptr<Opponent> opponent)
      : options_(options),
        camera_(std::move(camera)),
        audience_(std::move(link)),
        game_(std::move(game)),
        opponent_(std::move(opponent)) {}

  Result<void> run();

 private:
  void wait_for_renderer();
  Result<std::optional<Frame>> take_frame();
  Observation look(const Frame& frame);
  GameOutputs play(const Frame& frame, const Observation& observation);
  void obey(const Control& control);
  void think(const std::string& fen);
  std::optional<std::string> engine_answer();
  void publish(const Frame& frame, const Observation& observation, const GameOutputs& outputs);
  void wait_for_composite(const FrameStamp& stamp);
  Result<void> keep(const GameOutputs& outputs);
  Result<void> write_report() const;

  const ServeOptions& options_;
  std::unique_ptr<Camera> camera_;
  Audience audience_;
  std::optional<ObserveContext> context_;  // made with the first frame: only then the camera knows its lens
  Game game_;
  std::unique_ptr<Opponent> opponent_;
  ShowActivity show_;
  PoseLog poses_;
  StepTimes times_;
  std::uint64_t frames_ = 0;
  std::uint64_t frames_ok_ = 0;
  std::uint64_t captures_ = 0;
  nlohmann::json illegal_ = nlohmann::json::array();
  std::optional<std::string> pending_move_;  // the engine's, held until the human has thought long enough
  std::string thinking_about_;               // the position that the opponent is asked about; empty: none
  std::int64_t thought_since_ns_ = 0;
  std::int64_t act_at_ns_ = 0;
  std::int64_t now_ns_ = 0;
  bool quit_ = false;
  std::string kept_;  // the game as it was last saved
};

Result<void> Server::run() {
  if (auto opened = poses_.open(options_.poses_file); !opened) return opened;
  if (options_.lockstep) wait_for_renderer();
  while (!stop_requested() && !quit_ && (options_.frames == 0 || frames_ < options_.frames)) {
    auto frame = take_frame();
    if (!frame) {
      static_cast<void>(write_report());
      return tl::make_unexpected(frame.error());
    }
    if (!*frame) break;  // the camera has ended
    now_ns_ = (**frame).stamp.capture_ns;
    const Observation observation = look(**frame);
    const GameOutputs outputs = play(**frame, observation);
    if (auto kept = keep(outputs); !kept) return kept;
    publish(**frame, observation, outputs);
    if (options_.lockstep) wait_for_composite((**frame).stamp);
    camera_->done((**frame).stamp);
    poses_.add(observation.pose, observation.intrinsics, options_.observe.board, pose_ms(observation));
    ++frames_;
    if (observation.pose.status == TrackStatus::ok || observation.pose.status == TrackStatus::relocalised) ++frames_ok_;
  }
  audience_.say_goodbye("the camera has ended");
  if (auto closed = poses_.close(); !closed) return closed;
  if (auto reported = write_report(); !reported) return reported;
  if (frames_ > 0 && frames_ok_ == 0 && !stop_requested()) {
    return failure(ErrorCode::not_found,
                   "no board of " + std::to_string(options_.observe.board.squares) + " squares a side was found in " +
                       std::to_string(frames_) +
                       " frames; is all of it in the picture? --squares and --init corners=... help");
  }
  return {};
}

void Server::wait_for_renderer() {
  if (!audience_.has_renderer()) spdlog::info("lockstep: waiting for a renderer on {}", audience_.address());
  while (!stop_requested() && !audience_.has_renderer()) audience_.hear(kWaitNs);
}

Result<std::optional<Frame>> Server::take_frame() {
  const StepTimer timer(times_, "camera");
  return camera_->next();
}

Observation Server::look(const Frame& frame) {
  const StepTimer timer(times_, "observe");
  if (!context_) {
    ObserveOptions options = options_.observe;
    if (!options.intrinsics) options.intrinsics = camera_->intrinsics();
    context_.emplace(options);
  }
  if (options_.activity == Activity::game) context_->expect(real_pieces(game_.board_state(), options_.game.both_real));
  Observation observation = observe(frame, *context_);
  for (const auto& [step, ms] : observation.step_ms) times_.add(step, ms);
  return observation;
}

GameOutputs Server::play(const Frame& frame, const Observation& observation) {
  const StepTimer timer(times_, "game");
  audience_.hear(0);
  Heard heard = audience_.take_heard();
  for (const Control& control : heard.controls) obey(control);
  if (options_.activity == Activity::show) return show_.step(observation, options_.game, heard.renderer_joined);

  GameInputs inputs;
  inputs.now_ns = frame.stamp.capture_ns;
  inputs.sight = observation.occupancy;
  inputs.feedback = std::move(heard.feedback);
  inputs.controls = std::move(heard.controls);
  inputs.renderer_joined = heard.renderer_joined;
  inputs.engine_move = engine_answer();
  GameOutputs outputs = game_.step(inputs);
  if (outputs.think) think(*outputs.think);
  for (const std::string& sentence : outputs.rejected) spdlog::warn("{}", sentence);
  return outputs;
}

// What concerns the daemon and not the game.
void Server::obey(const Control& control) {
  if (control.kind == ControlKind::corners && control.corners_px.size() == 8) {
    std::array<double, 8> corners{};
    std::copy(control.corners_px.begin(), control.corners_px.end(), corners.begin());
    context_->restart(corners);
  } else if (control.kind == ControlKind::read_again) {
    context_->read_again();
  } else if (control.kind == ControlKind::quit) {
    spdlog::info("asked to quit");
    quit_ = true;
  } else if (control.kind == ControlKind::level) {
    OpponentOptions wanted = options_.opponent;
    wanted.level = control.number;
    auto opponent = make_opponent(wanted);
    if (!opponent) {
      spdlog::warn("the level stays as it is: {}", opponent.error().message);
      return;
    }
    opponent_ = std::move(*opponent);
    if (!thinking_about_.empty()) opponent_->think(thinking_about_);
  }
}

void Server::think(const std::string& fen) {
  pending_move_.reset();
  thinking_about_ = fen;
  thought_since_ns_ = now_ns_;
  opponent_->think(fen);
}

// The move is computed at once but made when a person would have made it.
std::optional<std::string> Server::engine_answer() {
  if (!pending_move_) {
    auto answer = opponent_->poll();
    if (!answer) return std::nullopt;
    if (!*answer) {
      spdlog::error("the opponent has no move: {}", answer->error().message);
      return std::nullopt;
    }
    pending_move_ = (**answer).move;
    thinking_about_.clear();
    act_at_ns_ = thought_since_ns_ + static_cast<std::int64_t>((**answer).acted_thinking_s * 1e9);
  }
  if (now_ns_ < act_at_ns_) return std::nullopt;
  return std::exchange(pending_move_, std::nullopt);
}

void Server::publish(const Frame& frame, const Observation& observation, const GameOutputs& outputs) {
  const StepTimer timer(times_, "publish");
  // What acts on this frame goes out before the frame itself.
  audience_.show_snapshot(observation.intrinsics);
  if (outputs.scene) audience_.show_snapshot(*outputs.scene);
  if (outputs.board_state) {
    audience_.show_snapshot(*outputs.board_state);
    camera_->tell(*outputs.board_state);
  }
  for (const GameEvent& event : outputs.events) {
    audience_.broadcast(event);
    camera_->tell(event);
  }
  for (const Command& command : outputs.commands) audience_.order(command);
  if (observation.mask) audience_.broadcast(*observation.mask);
  audience_.broadcast(observation.pose);
  audience_.broadcast(observation.debug);
  audience_.show(frame);
}

void Server::wait_for_composite(const FrameStamp& stamp) {
  const StepTimer timer(times_, "wait_for_composite");
  while (!stop_requested() && !audience_.composited(stamp.frame_id)) {
    if (!audience_.has_renderer()) wait_for_renderer();
    if (audience_.fresh_renderer()) return;  // it has never seen this frame; the next one greets it
    audience_.hear(kWaitNs);
  }
}

Result<void> Server::keep(const GameOutputs& outputs) {
  for (const GameEvent& event : outputs.events) {
    captures_ += event.kind == EventKind::captured ? event.captured.size() : 0;
    if (event.kind == EventKind::illegal_move) {
      illegal_.push_back({{"frame", frames_}, {"code", event.code}, {"squares", event.squares}});
    }
  }
  if (options_.activity != Activity::game) return {};
  if (!options_.state_folder.empty()) {
    std::string text = game_.save();
    if (text != kept_) {
      if (auto saved = save_game(options_.state_folder, text); !saved) return saved;
      kept_ = std::move(text);
    }
  }
  if (!options_.pdn_file.empty() && (outputs.board_state || frames_ == 0)) {
    return replace_file(options_.pdn_file, game_.pdn());
  }
  return {};
}

Result<void> Server::write_report() const {
  if (options_.report_file.empty()) return {};
  const BoardState& state = game_.board_state();
  nlohmann::json report;
  report["frames"] = frames_;
  report["frames_with_pose"] = frames_ok_;
  report["camera_dropped"] = camera_->dropped();
  report["ms"] = times_.report();
  report["moves"] = state.moves;
  report["captured"] = captures_;
  report["illegal_moves"] = illegal_;
  report["links"] = audience_.report();
  return replace_file(options_.report_file, report.dump(2) + "\n");
}

Result<Game> begin_game(const ServeOptions& options) {
  if (options.state_folder.empty() || options.activity != Activity::game) return Game::start(options.game);
  auto saved = load_game(options.state_folder);
  if (!saved) return tl::make_unexpected(saved.error());
  if (!*saved) return Game::start(options.game);
  spdlog::info("going on with the game kept in {}", options.state_folder);
  return Game::resume(options.game, **saved);
}

}  // namespace

Result<void> serve(const ServeOptions& options) {
  auto link = listen_tcp(options.listen, options.link);
  if (!link) return tl::make_unexpected(link.error());
  spdlog::info("tracker_server listens on {}", (*link)->address());
  auto game = begin_game(options);
  if (!game) return tl::make_unexpected(game.error());
  auto opponent = make_opponent(options.opponent);
  if (!opponent) return tl::make_unexpected(opponent.error());
  auto camera =
      open_camera(options.camera_uri, options.lockstep ? Pace::lockstep : Pace::realtime, options.camera_access);
  if (!camera) return tl::make_unexpected(camera.error());
  return Server(options, std::move(*camera), std::move(*link), std::move(*game), std::move(*opponent)).run();
}

}  // namespace counterpart
