#include "vhd_renderer/programs/play.hpp"

#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "protocol/codec/json.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"
#include "vhd_renderer/body/build_character.hpp"
#include "vhd_renderer/composite/composite.hpp"
#include "vhd_renderer/motion/clip_file.hpp"
#include "vhd_renderer/motion/director.hpp"
#include "vhd_renderer/output/output.hpp"
#include "vhd_renderer/programs/backdrop.hpp"
#include "vhd_renderer/programs/script.hpp"
#include "vhd_renderer/programs/trace.hpp"
#include "vhd_renderer/scene/virtual_scene.hpp"
#include "vhd_renderer/voice/espeak.hpp"

namespace counterpart {
namespace {

struct PlayOptions {
  std::string script;
  std::string trace;
  std::string out;
  std::string background;
  std::string size = "720x576";
  std::vector<double> eye;
  std::vector<double> look_at;
  double zoom = ViewPoint{}.zoom;
  std::string opponent;
  std::string clips;
  bool mute = false;
  double fps = 25;
  double seconds = 0;  // 0: until every command has ended
};

// WIDTHxHEIGHT
Result<Backdrop> backdrop_of(const PlayOptions& options) {
  if (!options.background.empty()) return Backdrop::from_sequence(options.background);
  int width = 0;
  int height = 0;
  char times = 0;
  char more = 0;
  std::istringstream in(options.size);
  const bool read = static_cast<bool>(in >> width >> times >> height) && times == 'x' && !(in >> more);
  if (!read || width < 64 || height < 64 || width > 4096 || height > 4096) {
    return failure(ErrorCode::invalid_argument, "--size " + options.size + ": give WIDTHxHEIGHT, each from 64 to 4096");
  }
  ViewPoint from;
  const auto place = [](const std::vector<double>& given, Eigen::Vector3d& into) {
    if (!given.empty()) into = {given[0], given[1], given[2]};
  };
  place(options.eye, from.eye_B);
  place(options.look_at, from.look_at_B);
  from.zoom = options.zoom;
  if ((from.eye_B - from.look_at_B).head<2>().norm() < 0.01) {
    return failure(ErrorCode::invalid_argument, "--eye and --look-at: the camera may not look straight up or down");
  }
  return Backdrop::plain(width, height, from);
}

// The film: what the director shows, drawn over the backdrop.
class Film {
 public:
  // speaks: there will be something to hear.
  static Result<Film> open(const PlayOptions& options, const Figure& figure, bool speaks) {
    auto backdrop = backdrop_of(options);
    if (!backdrop) return tl::make_unexpected(backdrop.error());
    auto drawing = VirtualScene::create(backdrop->width(), backdrop->height(), figure);
    if (!drawing) return tl::make_unexpected(drawing.error());
    auto output = open_output(options.out, speaks ? Sound{}.rate_hz : 0);
    if (!output) return tl::make_unexpected(output.error());
    return Film(std::move(*backdrop), std::move(*drawing), std::move(*output));
  }

  Result<BackdropFrame> next(const Scene& scene) { return backdrop_.frame(index_, scene); }

  Result<void> add(const BackdropFrame& behind, const Scene& scene, const Director& director,
                   const Performance& performance, std::int64_t now_ns) {
    cv::Mat picture = behind.bgr;
    if (behind.seen) {
      const auto drawn = drawing_->draw(behind.view, scene, performance, director.morph_names());
      if (!drawn) return tl::make_unexpected(drawn.error());
      CompositeOptions how;
      how.seed = index_;
      picture = composite(behind.bgr, *drawn, nullptr, how);
    }
    ++index_;
    output_->hear(performance.sound, performance.sound_s);
    return output_->write(picture, now_ns);
  }

  Result<void> finish() { return output_->finish(); }

 private:
  Film(Backdrop backdrop, std::unique_ptr<VirtualScene> drawing, std::unique_ptr<Output> output)
      : backdrop_(std::move(backdrop)), drawing_(std::move(drawing)), output_(std::move(output)) {}

  Backdrop backdrop_;
  std::unique_ptr<VirtualScene> drawing_;
  std::unique_ptr<Output> output_;
  std::size_t index_ = 0;
};

Result<void> play(const PlayOptions& options) {
  std::ifstream file(options.script);
  if (!file) return failure(ErrorCode::not_found, "there is no script " + options.script);
  const auto script = read_script(file, options.script);
  if (!script) return tl::make_unexpected(script.error());
  std::string opponent = options.opponent;
  std::size_t open = 0;
  bool speaks = false;
  for (const ScriptLine& line : *script) {
    if (const auto* scene = std::get_if<Scene>(&line.what); scene != nullptr && opponent.empty()) {
      opponent = scene->opponent;
    }
    if (const auto* command = std::get_if<Command>(&line.what); command != nullptr) {
      ++open;
      speaks = speaks || std::holds_alternative<Say>(command->action);
    }
  }
  auto figure = figure_of(opponent.empty() ? "default" : opponent);
  if (!figure && options.opponent.empty()) {
    spdlog::warn("{}; the mannequin plays instead", figure.error().message);
    figure = figure_of("mannequin");
  }
  if (!figure) return tl::make_unexpected(figure.error());
  auto clips = clips_with_folder(options.clips);
  if (!clips) return tl::make_unexpected(clips.error());
  std::ofstream trace_file;
  if (!options.trace.empty()) {
    trace_file.open(options.trace);
    if (!trace_file) return failure(ErrorCode::io, "cannot write the trace " + options.trace);
  }

  std::optional<Film> film;
  if (!options.out.empty()) {
    auto opened = Film::open(options, *figure, speaks);
    if (!opened) return tl::make_unexpected(opened.error());
    film.emplace(std::move(*opened));
  }

  Director director(*figure, options.mute ? Speaker{} : espeak_speaker(voice_of(opponent), Speaking::at_once),
                    std::move(*clips), grips_kept_in(default_cache() / "grips"));
  std::optional<Trace> trace;
  if (trace_file.is_open()) trace.emplace(*figure, director);
  Scene shown;
  const auto limit = static_cast<std::int64_t>((options.seconds > 0 ? options.seconds : 3600) * options.fps);
  std::size_t next = 0;
  std::int64_t last = limit;
  for (std::int64_t frame = 0; frame < std::min(limit, last); ++frame) {
    DirectorInputs inputs;
    inputs.now_ns = static_cast<std::int64_t>(static_cast<double>(frame) * 1e9 / options.fps);
    const Scene* scene = nullptr;
    for (; next < script->size() && (*script)[next].at_ms * 1'000'000 <= inputs.now_ns; ++next) {
      if (const auto* command = std::get_if<Command>(&(*script)[next].what)) inputs.commands.push_back(*command);
      if (const auto* given = std::get_if<Scene>(&(*script)[next].what)) scene = given;
    }
    inputs.scene = scene;
    if (scene != nullptr) shown = *scene;
    BackdropFrame behind;
    if (film) {
      auto frame_behind = film->next(shown);
      if (!frame_behind) return tl::make_unexpected(frame_behind.error());
      behind = std::move(*frame_behind);
      if (behind.seen) inputs.camera_B = to_point(camera_position_B(behind.view));
    }
    const Performance performance = director.step(inputs);
    for (const Feedback& feedback : performance.feedback) {
      std::cout << to_json_text(feedback) << '\n';
      if (is_final(feedback.state) && open > 0) --open;
    }
    if (film) {
      if (auto added = film->add(behind, shown, director, performance, inputs.now_ns); !added) return added;
    }
    if (trace) trace_file << trace->line(frame, inputs.now_ns, performance).dump() << '\n';
    // A second of stillness at the end.
    if (open == 0 && next == script->size() && options.seconds <= 0 && last == limit) {
      last = frame + static_cast<std::int64_t>(options.fps);
    }
  }
  std::cout.flush();
  if (film) {
    if (auto finished = film->finish(); !finished) return finished;
  }
  if (trace && !trace_file.flush()) return failure(ErrorCode::io, "the trace could not be written whole");
  return {};
}

}  // namespace

void add_play(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command =
      app.add_subcommand("play", "Plays a script of commands offline; every answer is a JSON line on stdout");
  command->add_option("script", options->script, "JSON lines: commands and scenes with at_ms")->required();
  command->add_option("--trace", options->trace,
                      "a JSON line a frame: every joint, piece and the fingertips' skin in B, metres");
  command->add_option("--out", options->out, "FILE.mp4, or a folder for pictures; without it nothing is drawn");
  command->add_option("--background", options->background,
                      "a SEQUENCE folder: pictures, camera.json, poses.csv; without it a plain room is painted");
  command->add_option("--size", options->size, "of the picture with the plain room, WIDTHxHEIGHT")
      ->capture_default_str();
  const auto three = [&](const char* name, std::vector<double>& into, const char* what) {
    command->add_option(name, into, what)->expected(3)->delimiter(',')->check(CLI::Range(-20.0, 20.0));
  };
  three("--eye", options->eye, "where the plain room is seen from, X,Y,Z in B, metres");
  three("--look-at", options->look_at, "what is in the middle of the picture then, X,Y,Z");
  command->add_option("--zoom", options->zoom, "focal length of the plain room's camera, in heights of the picture")
      ->check(CLI::Range(0.2, 20.0))
      ->capture_default_str();
  command->add_option("--opponent", options->opponent,
                      "which human: default, ines, kenji, amara, mannequin, a GLB file");
  command->add_option("--clips", options->clips, "a folder with more clips: .bvh, .gltf, .glb, .json");
  command->add_flag("--mute", options->mute, "what is said is only shown, not spoken");
  command->add_option("--fps", options->fps, "frames a second")->check(CLI::Range(1.0, 240.0))->capture_default_str();
  command->add_option("--seconds", options->seconds, "how long; 0: until every command has ended")
      ->check(CLI::Range(0.0, 36000.0));
  command->callback([options, &exit_code] {
    if (auto played = play(*options); !played) {
      spdlog::error("{}", played.error().message);
      exit_code = 1;
    }
  });
}

}  // namespace counterpart
