#include "tracker_server/pipeline/serve.hpp"

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "protocol/daemon/picture_memory.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/h264/h264.hpp"
#include "tracker_server/pipeline/board_file.hpp"
#include "tracker_server/programs/corners.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct Arguments {
  ServeOptions serve;
  std::string board_file;
  std::string init = "auto";
  std::string virtual_side = "light";
  std::string real = "one";
  std::string activity = "game";
  std::string video = "auto";
  std::string pieces = "appearance";
  double square_size_m = 0;
};

Result<void> complete(Arguments& arguments) {
  ServeOptions& serve = arguments.serve;
  if (!arguments.board_file.empty()) {
    const auto board = read_board_file(arguments.board_file);
    if (!board) return tl::make_unexpected(board.error());
    serve.observe.board = *board;
  }
  if (arguments.square_size_m > 0) serve.observe.board.square_size_m = arguments.square_size_m;
  if (arguments.init.rfind("corners=", 0) == 0) {
    const auto corners = corners_from(arguments.init.substr(std::string("corners=").size()));
    if (!corners) return tl::make_unexpected(corners.error());
    serve.observe.corners_px = *corners;
  } else if (arguments.init != "auto") {
    return failure(ErrorCode::invalid_argument, "--init " + arguments.init + ": auto or corners=x0,y0,...,x3,y3");
  }
  serve.observe.lockstep = serve.lockstep;
  if (arguments.pieces == "scan-segments") serve.observe.method = ReadingMethod::scan_segments;
  serve.game.board = serve.observe.board;
  if (serve.observe.board.squares == 8 && serve.game.rules == "international") serve.game.rules = "brazilian";
  serve.game.virtual_side = arguments.virtual_side == "light" ? Side::light : Side::dark;
  serve.game.both_real = arguments.real == "both";
  serve.opponent.rules = serve.game.rules;
  serve.opponent.lockstep = serve.lockstep;
  serve.activity = arguments.activity == "game" ? Activity::game : Activity::show;
  serve.link.role = Role::tracker;
  serve.link.software = "tracker_server " COUNTERPART_VERSION;
  serve.link.lockstep = serve.lockstep;
  if (arguments.video == "raw") serve.link.video_codec = PixelCodec::raw_bgr8;
  if (arguments.video == "jpeg") serve.link.video_codec = PixelCodec::jpeg;
  if (arguments.video == "h264") serve.link.video_codec = PixelCodec::h264;
  use_h264(serve.link);
  return {};
}

}  // namespace

void add_serve(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  ServeOptions& serve = arguments->serve;
  CLI::App* command =
      app.add_subcommand("serve", "The daemon: watches the board, plays, and directs the virtual human");
  command
      ->add_option("--camera", serve.camera_uri,
                   "/dev/videoN, film, folder of pictures, rtsp://, http:// or vhp://HOST:PORT")
      ->required();
  command->add_option("--listen", serve.listen, "HOST:PORT for renderers and tools")->capture_default_str();
  command->add_option("--token-file", serve.link.token_file, "needed to listen on anything but loopback");
  command->add_option("--tls-file", serve.link.tls_file, "TLS 1.3, with this file of vhp certificate");
  command->add_option("--camera-token-file", serve.camera_access.token_file, "that a vhp:// camera asks for");
  command->add_option("--camera-tls-file", serve.camera_access.tls_file, "for a vhp:// camera that speaks TLS");
  command->add_option("--board", arguments->board_file, "JSON with the board's sizes");
  command->add_option("--squares", serve.observe.board.squares, "a side")
      ->check(CLI::IsMember({8, 10}))
      ->capture_default_str();
  command->add_option("--square-size", arguments->square_size_m, "metres")->check(CLI::Range(0.005, 1.0));
  command->add_option("--init", arguments->init, "auto, or corners=x0,y0,...,x3,y3 of the playing surface")
      ->capture_default_str();
  command
      ->add_option("--pieces", arguments->pieces,
                   "how squares are read: appearance, or scan-segments as in the paper of 2000")
      ->check(CLI::IsMember({"appearance", "scan-segments"}))
      ->capture_default_str();
  command->add_option("--rules", serve.game.rules, "international, brazilian or english")->capture_default_str();
  command->add_option("--fen", serve.game.start_fen, "start from this position");
  command->add_option("--virtual-side", arguments->virtual_side, "the side the virtual human plays")
      ->check(CLI::IsMember({"light", "dark"}))
      ->capture_default_str();
  command
      ->add_option(
          "--real", arguments->real,
          "whose pieces stand on the real board: one (the real player's; the others exist on the screen only) or "
          "both (the virtual human asks the player to move his for him)")
      ->check(CLI::IsMember({"one", "both"}))
      ->capture_default_str();
  command->add_option("--level", serve.opponent.level, "1 (a beginner beats it) to 8")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->add_option(
      "--opponent", serve.opponent.mind,
      "who finds the virtual player's moves: hub:COMMAND (any Hub 2 engine) or dxp:HOST:PORT (a distant "
      "program or person); default: the built-in engine");
  command->add_option("--opponent-time", serve.opponent.move_time_s, "seconds a move of a Hub engine")
      ->check(CLI::Range(0.01, 3'600.0))
      ->capture_default_str();
  command->add_option("--seed", serve.opponent.seed, "of the choice among near-equal moves")->capture_default_str();
  command->add_option("--activity", arguments->activity, "game, or show: a short performance for a film")
      ->check(CLI::IsMember({"game", "show"}))
      ->capture_default_str();
  command->add_flag("--lockstep", serve.lockstep, "no frame dropped, no clock read: two runs give the same");
  command->add_option("--frames", serve.frames, "stop after so many");
  command->add_option("--state", serve.state_folder, "keep the game here and go on with it after a restart");
  command->add_option("--pdn", serve.pdn_file, "write the game here, anew with every move");
  command->add_option("--poses", serve.poses_file, "write every pose here, CSV");
  command->add_option("--report", serve.report_file, "write counts and times here at the end, JSON");
  command->add_option("--record", serve.link.record_file, "capture everything on the link, MCAP");
  command
      ->add_option("--video", arguments->video,
                   "raw, jpeg, h264, or auto: raw on loopback, between hosts by what the link carries")
      ->check(CLI::IsMember({"auto", "raw", "jpeg", "h264"}))
      ->capture_default_str();
  command->callback([arguments, &exit_code] {
    if (auto completed = complete(*arguments); !completed) {
      spdlog::error("{}", completed.error().message);
      exit_code = completed.error().code == ErrorCode::invalid_argument ? 2 : 1;
      return;
    }
    catch_stop_signals();
    keep_picture_memory();
    if (auto served = counterpart::serve(arguments->serve); !served) {
      spdlog::error("{}", served.error().message);
      exit_code = 1;
    }
  });
}

}  // namespace counterpart
