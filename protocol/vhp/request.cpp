#include "protocol/vhp/request.hpp"

#include <chrono>
#include <cstdlib>
#include <sstream>

#include <CLI/CLI.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart::vhp {
namespace {

// "X,Y", "X,Y,Z" in metres, or the number of a square.
Result<Point3> read_point(const std::string& text, const BoardGeometry& board) {
  Point3 point{};
  std::istringstream in(text);
  std::string part;
  std::size_t count = 0;
  while (std::getline(in, part, ',')) {
    std::size_t used = 0;
    try {
      const double value = std::stod(part, &used);
      if (count < 3) point[count] = value;
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != part.size()) count = 9;
    ++count;
  }
  if (count == 2 || count == 3) return point;
  if (count == 1 && text.find_first_not_of("0123456789") == std::string::npos) {
    const int square = std::stoi(text.substr(0, 4));
    if (is_square(square, board.squares)) return centre_of_square_B(square, board);
  }
  return failure(ErrorCode::invalid_argument,
                 "\"" + text + "\" is not a place: write X,Y or X,Y,Z in metres on the board, or a square's number");
}

Result<std::vector<Point3>> read_path(const Request& arguments) {
  std::vector<Point3> path;
  for (const std::string& text : arguments.path) {
    auto point = read_point(text, arguments.board);
    if (!point) return tl::make_unexpected(point.error());
    path.push_back(*point);
  }
  return path;
}

[[noreturn]] void reject(const Error& error) {
  throw CLI::ValidationError("send", error.message);
}

template <class T>
T accepted(Result<T> result) {
  if (!result) reject(result.error());
  return *std::move(result);
}

template <class E>
E word(const std::string& name) {
  const auto value = from_name<E>(name);
  if (!value) reject({ErrorCode::invalid_argument, "\"" + name + "\" must be one of " + all_names<E>()});
  return *value;
}

using Shared = std::shared_ptr<Request>;

// A subcommand whose `fill` puts what was written into the command.
template <class Fill>
CLI::App* verb(CLI::App& send, const char* name, const char* what, const Shared& arguments, Fill fill) {
  CLI::App* command = send.add_subcommand(name, what);
  command->fallthrough();
  command->callback([arguments, fill] { fill(*arguments); });
  return command;
}

void add_grasp(CLI::App& send, const Shared& a) {
  CLI::App* command = verb(send, "grasp", "Take a piece along a path of places", a, [](Request& args) {
    args.grasp.path_B = accepted(read_path(args));
    args.grasp.hand = word<Hand>(args.hand);
    if (args.grasp.piece == "-") args.grasp.piece.clear();
    args.command.action = args.grasp;
  });
  command->add_option("piece", a->grasp.piece, "Name of the piece, e.g. light_31; - only touches the place")
      ->required();
  command->add_option("path", a->path, "Places: squares' numbers, or X,Y[,Z] in metres")->required();
  command->add_option("--hand", a->hand, "any, left or right");
  command->add_option("--style", a->grasp.style, "\"\", slam or hesitant");
  command->add_option("--duration", a->grasp.duration_s, "Seconds; 0: as a person would take");
}

void add_keyframe(CLI::App& send, const Shared& a) {
  CLI::App* command = verb(send, "keyframe", "Play a clip", a, [](Request& args) {
    args.keyframe.part = word<BodyPart>(args.part);
    args.command.action = args.keyframe;
  });
  command->add_option("clip", a->keyframe.clip, "nod, head_shake, ...")->required();
  command->add_option("--speed", a->keyframe.speed, "1: as made");
  command->add_option("--weight", a->keyframe.weight, "0..1");
  command->add_option("--part", a->part, "whole, upper, head, left_arm, right_arm, face, legs");
  command->add_flag("--loop", a->keyframe.loop, "Until stopped");
}

void add_navigate(CLI::App& send, const Shared& a) {
  CLI::App* command = verb(send, "navigate", "Walk somewhere", a, [](Request& args) {
    args.navigate.path_B = accepted(read_path(args));
    args.command.action = args.navigate;
  });
  command->add_option("place", a->navigate.place, "entrance, chair, seat or away");
  command->add_option("--path", a->path, "Floor points X,Y in metres");
  command->add_option("--heading", a->navigate.heading_rad, "At the end of the path, radians from x towards y");
  command->add_option("--gait", a->navigate.gait, "walk or hurry");
}

void add_gaze(CLI::App& send, const Shared& a) {
  CLI::App* command = verb(send, "gaze", "Look at something", a, [](Request& args) {
    args.gaze.target = word<GazeTarget>(args.target);
    if (args.gaze.target == GazeTarget::piece) args.gaze.piece = args.what;
    if (args.gaze.target == GazeTarget::square || args.gaze.target == GazeTarget::point) {
      args.gaze.point_B = accepted(read_point(args.what, args.board));
      if (args.gaze.target == GazeTarget::square) args.gaze.square = std::atoi(args.what.c_str());
    }
    args.command.action = args.gaze;
  });
  command->add_option("target", a->target, "square, piece, player, camera, point or ahead")->required();
  command->add_option("what", a->what, "The square's number, the piece's name or X,Y,Z");
  command->add_option("--hold", a->gaze.hold_s, "Seconds; 0: until the next gaze");
}

void add_others(CLI::App& send, const Shared& a) {
  CLI::App* say = verb(send, "say", "Speak", a, [](Request& args) { args.command.action = args.say; });
  say->add_option("text", a->say.text, "What to say")->required();
  say->add_option("--language", a->say.language, "en, fr, ...");
  say->add_option("--code", a->say.code, "What is meant");

  CLI::App* express =
      verb(send, "express", "Put on a face", a, [](Request& args) { args.command.action = args.express; });
  express->add_option("face", a->express.face, "neutral, smile, frown, surprise, doubt or sad")->required();
  express->add_option("--weight", a->express.weight, "0..1");
  express->add_option("--hold", a->express.hold_s, "Seconds; 0: until the next face");

  CLI::App* stop = verb(send, "stop", "Stop commands", a, [](Request& args) { args.command.action = args.stop; });
  stop->add_option("ids", a->stop.commands, "Ids of the commands; none: everything");

  CLI::App* raw = verb(send, "json", "A command as docs/protocol.md writes it", a,
                       [](Request& args) { args.command = accepted(from_json_text<Command>(args.raw)); });
  raw->add_option("command", a->raw, R"({"id":1,"verb":"say","text":"hello"})")->required();

  CLI::App* control = verb(send, "control", "Ask something of the game", a, [](Request& args) {
    args.is_control = true;
    args.control.kind = word<ControlKind>(args.kind);
    for (const std::string& value : args.control_values) {
      if (args.control.kind == ControlKind::corners) {
        auto corner = read_point(value, args.board);
        if (!corner || value.find(',') == std::string::npos) {
          reject({ErrorCode::invalid_argument, "corners are four X,Y in pixels"});
        }
        args.control.corners_px.insert(args.control.corners_px.end(), {(*corner)[0], (*corner)[1]});
      } else if (args.control.kind == ControlKind::level) {
        args.control.number = std::atoi(value.c_str());
      } else {
        args.control.text += (args.control.text.empty() ? "" : " ") + value;
      }
    }
  });
  control
      ->add_option("kind", a->kind,
                   "new_game, undo, resign, pause, resume, read_again, it_was, level, swap_sides, "
                   "corners, hint or quit")
      ->required();
  control->add_option("values", a->control_values, "A FEN, a move, a level, or four corners X,Y in pixels");
}

}  // namespace

std::uint64_t new_id() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
}

void add_request(CLI::App& app, const Shared& a) {
  app.add_option("--id", a->command.id, "Of the command; 0: a new one");
  app.add_option("--after", a->command.after, "Wait until these commands have ended")->delimiter(',');
  app.add_option("--delay-ms", a->command.delay_ms, "And then so long")->check(CLI::NonNegativeNumber);
  app.add_option("--deadline-ms", a->command.deadline_ms, "Fail if not finished after so long")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--interrupt", a->command.interrupt, "Cancel what holds the same body parts");
  app.add_option("--squares", a->board.squares, "Squares a side, for places given by number")
      ->check(CLI::IsMember({8, 10}));
  app.add_option("--square-size", a->board.square_size_m, "Metres")->check(CLI::PositiveNumber);
  add_grasp(app, a);
  add_keyframe(app, a);
  add_navigate(app, a);
  add_gaze(app, a);
  add_others(app, a);
}

Result<Request> read_request(const std::string& line, const BoardGeometry& board) {
  const auto request = std::make_shared<Request>();
  request->board = board;
  CLI::App app;
  app.require_subcommand(1);
  add_request(app, request);
  try {
    app.parse(line, false);
  } catch (const CLI::ParseError& error) {
    return failure(ErrorCode::invalid_argument, error.what());
  }
  if (auto good = message_of(*request); !good) return tl::make_unexpected(good.error());
  return *request;
}

Result<Message> message_of(const Request& request) {
  const auto to_message = [](auto value) { return Message(std::move(value)); };
  if (request.is_control) return from_json_text<Control>(to_json_text(request.control)).map(to_message);
  return from_json_text<Command>(to_json_text(request.command)).map(to_message);
}

}  // namespace counterpart::vhp
