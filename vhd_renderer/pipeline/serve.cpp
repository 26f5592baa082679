#include "vhd_renderer/pipeline/serve.hpp"

#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <spdlog/spdlog.h>

#include "protocol/codec/names.hpp"
#include "protocol/daemon/step_times.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/h264/h264.hpp"
#include "protocol/transport/jpeg.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"
#include "vhd_renderer/body/build_character.hpp"
#include "vhd_renderer/motion/clip_file.hpp"
#include "vhd_renderer/motion/director.hpp"
#include "vhd_renderer/output/output.hpp"
#include "vhd_renderer/output/web_mirror.hpp"
#include "vhd_renderer/pipeline/director_port.hpp"
#include "vhd_renderer/pipeline/pairing.hpp"
#include "vhd_renderer/scene/virtual_scene.hpp"
#include "vhd_renderer/voice/espeak.hpp"

namespace counterpart {
namespace {

constexpr std::uint64_t kStatusFrames = 25;  // the page hears of rates so often

constexpr std::int64_t kWaitNs = 100'000'000;  // how often a waiting daemon looks for Ctrl-C

class RendererDaemon {
 public:
  RendererDaemon(const RendererOptions& options, std::unique_ptr<Endpoint> tracker, DirectorPort port, Figure figure,
                 ClipLibrary clips)
      : options_(options),
        tracker_(std::move(tracker)),
        port_(std::move(port)),
        pairing_(options.lockstep ? PairingPolicy::every : PairingPolicy::newest),
        figure_(std::move(figure)),
        director_(figure_,
                  espeak_speaker(voice_of(options.character),
                                 options.lockstep ? Speaking::at_once : Speaking::in_the_background),
                  std::move(clips), grips_kept_in(default_cache() / "grips")) {}

  [[nodiscard]] Result<void> open_outputs();
  [[nodiscard]] Result<void> run();

 private:
  void hear(std::int64_t timeout_ns);
  void receive(Message&& message);
  [[nodiscard]] Result<void> show(PairedFrame pair);
  Performance direct(const PairedFrame& pair);
  [[nodiscard]] Result<RenderedFrame> draw(const PairedFrame& pair, const Performance& performance);
  [[nodiscard]] Result<void> put_out(const cv::Mat& mirror, std::int64_t stamp_ns);
  void answer(const Performance& performance);
  void mirror_on_web(const cv::Mat& mirror, const PoseEstimate& pose, const Performance& performance);
  MirrorStatus status_of(const PoseEstimate& pose);
  std::int64_t own_time(std::int64_t capture_ns);
  [[nodiscard]] Result<void> write_report() const;

  const RendererOptions& options_;
  std::unique_ptr<Endpoint> tracker_;
  DirectorPort port_;
  Pairing pairing_;
  Figure figure_;
  Director director_;
  std::unique_ptr<VirtualScene> virtual_scene_;  // made when the picture's size is known
  std::vector<std::unique_ptr<Output>> outputs_;
  std::unique_ptr<WebMirror> web_;  // null: no page
  StepTimes times_;

  std::optional<Scene> scene_;
  bool scene_is_new_ = false;
  std::optional<Intrinsics> intrinsics_;
  std::vector<Command> commands_;
  bool ended_ = false;
  bool connected_ = false;
  std::chrono::steady_clock::time_point status_at_ = std::chrono::steady_clock::now();
  std::uint64_t frames_ = 0;
  std::uint64_t without_pose_ = 0;
  std::int64_t offset_ns_ = 0;  // of our time to the camera's, so that ours never goes back
  std::int64_t now_ns_ = 0;
  bool new_source_ = true;
};

Result<void> RendererDaemon::open_outputs() {
  for (const std::string& target : options_.outputs) {
    auto output = open_output(target, Sound{}.rate_hz);
    if (!output) return tl::make_unexpected(output.error());
    outputs_.push_back(std::move(*output));
  }
  if (options_.web.empty()) return {};
  auto web = WebMirror::listen(options_.web);
  if (!web) return tl::make_unexpected(web.error());
  web_ = std::move(*web);
  spdlog::info("the mirror is at http://{}", web_->address());
  return {};
}

Result<void> RendererDaemon::run() {
  while (!stop_requested()) {
    auto pair = pairing_.take();
    if (!pair && ended_) break;
    if (!pair) {
      hear(kWaitNs);
      continue;
    }
    const FrameStamp stamp = pair->video.stamp;
    if (auto shown = show(std::move(*pair)); !shown) return shown;
    tracker_->broadcast(FrameDone{stamp});
    hear(0);
  }
  for (auto& output : outputs_) {
    if (auto finished = output->finish(); !finished) return finished;
  }
  return write_report();
}

void RendererDaemon::hear(std::int64_t timeout_ns) {
  for (Inbound& inbound : tracker_->receive(timeout_ns)) {
    if (const auto* joined = std::get_if<PeerJoined>(&inbound)) {
      spdlog::info("joined {}{}", joined->software, joined->resumed ? " again" : "");
      connected_ = true;
      ended_ = false;
      if (!joined->resumed) {
        pairing_.restart();
        new_source_ = true;
      }
    } else if (const auto* left = std::get_if<PeerLeft>(&inbound)) {
      spdlog::warn("the tracker is gone: {}", left->reason.message);
      ended_ = ended_ || left->said_goodbye;
      connected_ = false;
    } else {
      receive(std::move(std::get<Received>(inbound).message));
    }
  }
}

void RendererDaemon::receive(Message&& message) {
  if (auto* video = std::get_if<VideoFrame>(&message)) {
    pairing_.add(std::move(*video));
  } else if (const auto* pose = std::get_if<PoseEstimate>(&message)) {
    if (pose->object_id == 0) pairing_.add(*pose);
  } else if (auto* mask = std::get_if<Mask>(&message)) {
    pairing_.add(std::move(*mask));
  } else if (const auto* intrinsics = std::get_if<Intrinsics>(&message)) {
    intrinsics_ = *intrinsics;
  } else if (auto* scene = std::get_if<Scene>(&message)) {
    scene_ = std::move(*scene);
    scene_is_new_ = true;
  } else if (auto* command = std::get_if<Command>(&message)) {
    commands_.push_back(std::move(*command));
  } else if (const auto* state = std::get_if<BoardState>(&message)) {
    if (web_) web_->say(*state);
  } else if (const auto* event = std::get_if<GameEvent>(&message)) {
    if (web_) web_->event(*event);
  }
}

// One frame of the mirror: the steps of docs/architecture.md.
Result<void> RendererDaemon::show(PairedFrame pair) {
  const StepTimer whole(times_, "frame");
  if (pair.video.codec != PixelCodec::raw_bgr8) {
    auto raw = convert(pair.video, PixelCodec::raw_bgr8);
    if (!raw) return tl::make_unexpected(raw.error());
    pair.video = std::move(*raw);
  }
  const cv::Mat camera(pair.video.height, pair.video.width, CV_8UC3, pair.video.bytes.data(), pair.video.stride);
  const Performance performance = direct(pair);
  cv::Mat mirror = camera;
  const bool can_draw = usable(pair.pose) && intrinsics_ && scene_ && intrinsics_->width == camera.cols;
  if (can_draw) {
    auto rendered = draw(pair, performance);
    if (!rendered) return tl::make_unexpected(rendered.error());
    const StepTimer timer(times_, "composite");
    CompositeOptions options = options_.composite;
    options.seed = pair.video.stamp.frame_id;
    mirror = composite(camera, *rendered, pair.mask ? &*pair.mask : nullptr, options);
  } else {
    ++without_pose_;
  }
  answer(performance);
  ++frames_;
  if (web_) mirror_on_web(mirror, pair.pose, performance);
  for (auto& output : outputs_) output->hear(performance.sound, performance.sound_s);
  return put_out(mirror, now_ns_);
}

// The page gets the picture and what is said; what people press there goes to the tracker.
void RendererDaemon::mirror_on_web(const cv::Mat& mirror, const PoseEstimate& pose, const Performance& performance) {
  const StepTimer timer(times_, "web");
  VideoFrame picture;
  picture.stamp = pose.stamp;
  picture.width = static_cast<std::uint16_t>(mirror.cols);
  picture.height = static_cast<std::uint16_t>(mirror.rows);
  picture.stride = static_cast<std::uint32_t>(mirror.cols) * 3;
  picture.bytes.resize(std::size_t{picture.stride} * picture.height);
  mirror.copyTo(cv::Mat(mirror.rows, mirror.cols, CV_8UC3, picture.bytes.data()));
  web_->show(std::move(picture));
  web_->subtitle(performance.subtitle);
  web_->speech(performance.sound);
  for (const Feedback& feedback : performance.feedback) web_->feedback(feedback);
  for (const Control& control : web_->take_controls()) tracker_->broadcast(control);
  if (frames_ % kStatusFrames == 0) web_->status(status_of(pose));
}

MirrorStatus RendererDaemon::status_of(const PoseEstimate& pose) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - status_at_).count();
  status_at_ = now;
  MirrorStatus status;
  status.fps = seconds > 0 ? static_cast<double>(kStatusFrames) / seconds : 0;
  status.frames = frames_;
  status.dropped = pairing_.dropped();
  status.tracker_connected = connected_;
  status.tracking = name_of(pose.status);
  for (const PeerStats& peer : tracker_->stats()) {
    if (peer.round_trip_ns >= 0) status.round_trip_ms = static_cast<double>(peer.round_trip_ns) * 1e-6;
  }
  return status;
}

// Another tracker, or a film that starts again, brings other stamps; the human's time goes on.
std::int64_t RendererDaemon::own_time(std::int64_t capture_ns) {
  constexpr std::int64_t kFrameNs = 40'000'000;
  if (std::exchange(new_source_, false) && frames_ > 0) offset_ns_ = now_ns_ + kFrameNs - capture_ns;
  now_ns_ = std::max(now_ns_, capture_ns + offset_ns_);
  return now_ns_;
}

Performance RendererDaemon::direct(const PairedFrame& pair) {
  const StepTimer timer(times_, "direct");
  DirectorInputs inputs;
  inputs.now_ns = own_time(pair.video.stamp.capture_ns);
  inputs.commands = std::exchange(commands_, {});
  for (Command& command : port_.take_commands()) inputs.commands.push_back(std::move(command));
  if (scene_is_new_) inputs.scene = &*scene_;
  scene_is_new_ = false;
  if (usable(pair.pose)) {
    const Eigen::Vector3d camera_B = to_eigen(pair.pose.X_CB).inverse().translation();
    inputs.camera_B = to_point(camera_B);
  }
  return director_.step(inputs);
}

Result<RenderedFrame> RendererDaemon::draw(const PairedFrame& pair, const Performance& performance) {
  const StepTimer timer(times_, "draw");
  if (!virtual_scene_) {
    auto made = VirtualScene::create(pair.video.width, pair.video.height, figure_);
    if (!made) return tl::make_unexpected(made.error());
    virtual_scene_ = std::move(*made);
    spdlog::info("drawing with {}", virtual_scene_->description());
  }
  const View view{*intrinsics_, to_eigen(pair.pose.X_CB)};
  return virtual_scene_->draw(view, *scene_, performance, director_.morph_names());
}

Result<void> RendererDaemon::put_out(const cv::Mat& mirror, std::int64_t stamp_ns) {
  const StepTimer timer(times_, "output");
  for (auto& output : outputs_) {
    if (auto written = output->write(mirror, stamp_ns); !written) return written;
  }
  return {};
}

void RendererDaemon::answer(const Performance& performance) {
  for (const Feedback& feedback : performance.feedback) {
    if (!port_.answer(feedback)) tracker_->broadcast(feedback);
  }
}

Result<void> RendererDaemon::write_report() const {
  if (options_.report_file.empty()) return {};
  nlohmann::json report;
  report["frames"] = frames_;
  report["frames_without_pose"] = without_pose_;
  report["dropped"] = pairing_.dropped();
  report["ms"] = times_.report();
  std::ofstream out(options_.report_file);
  out << report.dump(2) << "\n";
  if (!out) return failure(ErrorCode::io, "cannot write the report '" + options_.report_file + "'");
  return {};
}

Result<std::unique_ptr<Endpoint>> open_director_port(const RendererOptions& options) {
  if (options.listen.empty()) return std::unique_ptr<Endpoint>{};
  LinkOptions link = options.link;
  link.want_video = false;
  link.record_file.clear();
  return listen_tcp(options.listen, link);
}

}  // namespace

Result<void> serve(const RendererOptions& options) {
  auto figure = figure_of(options.character);
  if (!figure) return tl::make_unexpected(figure.error());
  auto clips = clips_with_folder(options.clips);
  if (!clips) return tl::make_unexpected(clips.error());
  auto port = open_director_port(options);
  if (!port) return tl::make_unexpected(port.error());
  LinkOptions link = options.link;
  use_h264(link);
  auto tracker = connect_tcp(options.tracker, link, options.patience_ns);
  if (!tracker) return tl::make_unexpected(tracker.error());
  RendererDaemon daemon(options, std::move(*tracker), DirectorPort(std::move(*port)), std::move(*figure),
                        std::move(*clips));
  if (auto opened = daemon.open_outputs(); !opened) return opened;
  return daemon.run();
}

}  // namespace counterpart
