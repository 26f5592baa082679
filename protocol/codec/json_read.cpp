#include <cmath>

#include <nlohmann/json.hpp>

#include "protocol/codec/fields.hpp"
#include "protocol/codec/json.hpp"

namespace counterpart {

using nlohmann::json;

namespace {

constexpr Range kPositive{1e-9, 1e9};
constexpr Range kNotNegative{0, 1e9};
constexpr Range kShare{0, 1};
constexpr Range kMetres{-1e4, 1e4};
constexpr Range kPixels{-1e6, 1e6};
constexpr Range kSquare{0, 50};

void read_fields(Fields& f, Hello& m) {
  f.need("version_min", m.version_min, {1, 255}).need("version_max", m.version_max, {1, 255}).need("role", m.role);
  f.maybe("software", m.software).maybe("resume_session", m.resume_session).maybe("last_seq", m.last_seq);
  f.maybe("video", m.video).maybe("want_video", m.want_video).maybe("lockstep", m.lockstep).maybe("h264", m.h264);
  f.maybe("want_debug", m.want_debug);
  f.require(m.version_min <= m.version_max, "version_min", "must not be above version_max");
}

void read_fields(Fields& f, Welcome& m) {
  f.need("version", m.version, {1, 255}).need("session", m.session).need("role", m.role);
  f.maybe("software", m.software).maybe("resumed", m.resumed).maybe("last_seq", m.last_seq);
  f.maybe("lockstep", m.lockstep);
  f.require(m.session != 0, "session", "must not be 0");
}

void read_fields(Fields& f, ErrorReport& m) {
  f.need("code", m.code).need("message", m.message);
}

void read_fields(Fields& f, Bye& m) {
  f.maybe("reason", m.reason);
}

void read_hex(Fields& f, const char* key, Bytes32& out) {
  std::string text;
  f.need(key, text);
  const bool good = text.size() == 64 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  f.require(good, key, "must be 64 hexadecimal digits");
  if (!good) return;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<std::uint8_t>(std::stoi(text.substr(2 * i, 2), nullptr, 16));
  }
}

void read_fields(Fields& f, Challenge& m) {
  read_hex(f, "nonce", m.nonce);
}

void read_fields(Fields& f, Proof& m) {
  read_hex(f, "nonce", m.nonce);
  read_hex(f, "mac", m.mac);
}

void read_fields(Fields& f, Intrinsics& m) {
  f.maybe("id", m.id).need("width", m.width, {1, 65535}).need("height", m.height, {1, 65535});
  f.need("fx", m.fx, kPositive).need("fy", m.fy, kPositive).need("cx", m.cx, kPixels).need("cy", m.cy, kPixels);
  f.maybe("dist", m.dist);
}

void read_points(Fields& f, const json& list, std::vector<DebugPoint>& out) {
  bool good = list.is_array() && list.size() <= kMaxListEntries;
  for (std::size_t i = 0; good && i < list.size(); ++i) {
    const json& entry = list[i];
    good = entry.is_array() && entry.size() == 3 && entry[0].is_number() && entry[1].is_number() &&
           entry[2].is_number_unsigned() && std::abs(entry[0].get<double>()) <= kPixels.most &&
           std::abs(entry[1].get<double>()) <= kPixels.most && entry[2].get<std::uint64_t>() <= 255;
    if (good) out.push_back({entry[0].get<float>(), entry[1].get<float>(), entry[2].get<std::uint8_t>()});
  }
  f.require(good, "points", "must be a list of [x, y, verdict]");
}

void read_fields(Fields& f, DebugView& m) {
  f.need("frame_id", m.stamp.frame_id).need("capture_ns", m.stamp.capture_ns);
  f.maybe("lines", m.lines, kPixels).maybe("readings", m.readings);
  if (f.has("points")) read_points(f, f.json().at("points"), m.points);
}

void read_fields(Fields& f, BoardState& m) {
  f.need("revision", m.revision).maybe("rules", m.rules).need("squares", m.squares).need("turn", m.turn);
  f.maybe("virtual_side", m.virtual_side).need("phase", m.phase).maybe("result", m.result);
  f.maybe("moves", m.moves).maybe("to_remove", m.to_remove, {1, 50}).maybe("start_fen", m.start_fen);
  f.require(m.rules == "international" || m.rules == "brazilian" || m.rules == "english", "rules",
            "must be international, brazilian or english");
  f.require(
      (m.squares.size() == 50 || m.squares.size() == 32) && m.squares.find_first_not_of("wbWBe") == std::string::npos,
      "squares", "must be 50 or 32 of the letters w b W B e");
}

void read_fields(Fields& f, GameEvent& m) {
  f.need("id", m.id).need("kind", m.kind).maybe("side", m.side).maybe("code", m.code).maybe("move", m.move);
  f.maybe("squares", m.squares, kSquare).maybe("captured", m.captured, kSquare).maybe("legal", m.legal);
  f.maybe("result", m.result).maybe("stamp_ns", m.stamp_ns);
}

void read_fields(Fields& f, Control& m) {
  f.need("id", m.id).need("kind", m.kind).maybe("text", m.text).maybe("number", m.number);
  f.maybe("corners_px", m.corners_px, kPixels);
  f.require(m.corners_px.size() == (m.kind == ControlKind::corners ? 8 : m.corners_px.size()), "corners_px",
            "must be 8 numbers, x0 y0 to x3 y3");
  f.require(m.corners_px.empty() || m.corners_px.size() == 8, "corners_px", "must be 8 numbers, or none");
}

void read_fields(Fields& f, BoardGeometry& m) {
  f.maybe("squares", m.squares, {8, 10}).maybe("square_size_m", m.square_size_m, {1e-4, 100});
  f.maybe("border_m", m.border_m, {0, 100}).maybe("thickness_m", m.thickness_m, {0, 100});
  f.maybe("piece_radius_m", m.piece_radius_m, {1e-5, 100}).maybe("piece_height_m", m.piece_height_m, {1e-5, 100});
  f.maybe("played_on", m.played_on);
  f.require(m.squares != 9, "squares", "must be 8 or 10");
}

void read_fields(Fields& f, Pose& m) {
  f.need("q", m.q).need("p", m.p, kMetres);
  const double norm = std::sqrt(m.q[0] * m.q[0] + m.q[1] * m.q[1] + m.q[2] * m.q[2] + m.q[3] * m.q[3]);
  f.require(std::abs(norm - 1) < 1e-3, "q", "must be a unit quaternion, w x y z");
}

void read_fields(Fields& f, ScenePiece& m) {
  f.need("name", m.name).need("side", m.side).maybe("king", m.king).maybe("real", m.real).need("p_b", m.p_B, kMetres);
}

void read_fields(Fields& f, SceneBox& m) {
  f.need("name", m.name).need("size_m", m.size_m, kNotNegative);
  f.object("x_bo", true, [&](Fields& inner) { read_fields(inner, m.X_BO); });
}

void read_fields(Fields& f, SceneLight& m) {
  f.maybe("direction_b", m.direction_B, kMetres)
      .maybe("colour", m.colour, {0, 1e3})
      .maybe("ambient", m.ambient, {0, 1e3});
}

void read_fields(Fields& f, Scene& m) {
  f.need("revision", m.revision).maybe("table_height_m", m.table_height_m, {0, 100});
  f.object("board", false, [&](Fields& inner) { read_fields(inner, m.board); });
  f.objects("pieces", m.pieces, [](Fields& inner, ScenePiece& piece) { read_fields(inner, piece); });
  f.objects("boxes", m.boxes, [](Fields& inner, SceneBox& box) { read_fields(inner, box); });
  f.object("light", false, [&](Fields& inner) { read_fields(inner, m.light); });
  f.maybe("virtual_side", m.virtual_side).maybe("opponent", m.opponent);
}

void read_fields(Fields& f, Grasp& a) {
  f.maybe("piece", a.piece).need("path_b", a.path_B, kMetres).maybe("hand", a.hand).maybe("style", a.style);
  f.maybe("duration_s", a.duration_s, {0, 3600});
  f.require(!a.path_B.empty(), "path_b", "must have at least one point");
}

void read_fields(Fields& f, Keyframe& a) {
  f.need("clip", a.clip).maybe("speed", a.speed, {1e-3, 100}).maybe("weight", a.weight, kShare);
  f.maybe("part", a.part).maybe("loop", a.loop);
}

void read_fields(Fields& f, Navigate& a) {
  f.maybe("place", a.place).maybe("path_b", a.path_B, kMetres).maybe("heading_rad", a.heading_rad, {-100, 100});
  f.maybe("gait", a.gait);
  f.require(!a.place.empty() || !a.path_B.empty(), "place", "is missing (or give path_b)");
}

void read_fields(Fields& f, Gaze& a) {
  f.need("target", a.target).maybe("square", a.square, kSquare).maybe("piece", a.piece);
  f.maybe("point_b", a.point_B, kMetres).maybe("hold_s", a.hold_s, {0, 3600});
}

void read_fields(Fields& f, Say& a) {
  f.need("text", a.text).maybe("language", a.language).maybe("code", a.code);
}

void read_fields(Fields& f, Express& a) {
  f.need("face", a.face).maybe("weight", a.weight, kShare).maybe("hold_s", a.hold_s, {0, 3600});
}

void read_fields(Fields& f, Stop& a) {
  f.maybe("commands", a.commands);
}

// The alternative of Action that this verb names, with its defaults.
template <std::size_t I = 0>
std::optional<Action> action_of(std::string_view verb) {
  if constexpr (I == std::variant_size_v<Action>) {
    return std::nullopt;
  } else {
    const Action action{std::in_place_index<I>};
    if (verb_of(action) == verb) return action;
    return action_of<I + 1>(verb);
  }
}

void read_fields(Fields& f, Command& m) {
  std::string verb;
  f.need("id", m.id).need("verb", verb);
  const auto action = action_of(verb);
  f.require(action.has_value(), "verb", "must be one of grasp, keyframe, navigate, gaze, say, express, stop");
  if (action) {
    m.action = *action;
    std::visit([&](auto& alternative) { read_fields(f, alternative); }, m.action);
  }
  f.maybe("after", m.after).maybe("delay_ms", m.delay_ms, {0, 86'400'000});
  f.maybe("deadline_ms", m.deadline_ms, {0, 86'400'000}).maybe("interrupt", m.interrupt);
}

void read_fields(Fields& f, Feedback& m) {
  f.need("command_id", m.command_id).need("state", m.state).maybe("verb", m.verb).maybe("phase", m.phase);
  f.maybe("code", m.code).maybe("gap_mm", m.gap_mm, {-1, 1e7}).maybe("stamp_ns", m.stamp_ns);
}

template <class T>
constexpr const char* kName = "message";
template <>
constexpr const char* kName<Intrinsics> = "intrinsics";
template <>
constexpr const char* kName<Command> = "command";
template <>
constexpr const char* kName<Scene> = "scene";
template <>
constexpr const char* kName<Control> = "control";
template <>
constexpr const char* kName<Feedback> = "feedback";
template <>
constexpr const char* kName<GameEvent> = "game_event";
template <>
constexpr const char* kName<BoardState> = "board_state";
template <>
constexpr const char* kName<BoardGeometry> = "board";
template <>
constexpr const char* kName<Pose> = "pose";
template <>
constexpr const char* kName<Hello> = "hello";
template <>
constexpr const char* kName<Welcome> = "welcome";
template <>
constexpr const char* kName<DebugView> = "debug";

}  // namespace

template <class T>
Result<T> from_json(const json& object) {
  Fields fields(object, kName<T>);
  T value{};
  read_fields(fields, value);
  return fields.result(std::move(value));
}

template <class T>
Result<T> from_json_text(std::string_view text) {
  const json object = json::parse(text.begin(), text.end(), nullptr, false);
  if (object.is_discarded()) {
    return failure(ErrorCode::bad_format, std::string(kName<T>) + " is not JSON");
  }
  return from_json<T>(object);
}

#define COUNTERPART_READ(T)                            \
  template Result<T> from_json<T>(const json& object); \
  template Result<T> from_json_text<T>(std::string_view text)
COUNTERPART_READ(Hello);
COUNTERPART_READ(Welcome);
COUNTERPART_READ(ErrorReport);
COUNTERPART_READ(Bye);
COUNTERPART_READ(Challenge);
COUNTERPART_READ(Proof);
COUNTERPART_READ(Intrinsics);
COUNTERPART_READ(DebugView);
COUNTERPART_READ(BoardState);
COUNTERPART_READ(GameEvent);
COUNTERPART_READ(Control);
COUNTERPART_READ(Scene);
COUNTERPART_READ(Command);
COUNTERPART_READ(Feedback);
COUNTERPART_READ(BoardGeometry);
COUNTERPART_READ(Pose);

}  // namespace counterpart
