#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {

using nlohmann::json;

namespace {

std::string hex(const Bytes32& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

json fields_of(const Grasp& g) {
  return {{"piece", g.piece},
          {"path_b", g.path_B},
          {"hand", name_of(g.hand)},
          {"style", g.style},
          {"duration_s", g.duration_s}};
}

json fields_of(const Keyframe& k) {
  return {{"clip", k.clip}, {"speed", k.speed}, {"weight", k.weight}, {"part", name_of(k.part)}, {"loop", k.loop}};
}

json fields_of(const Navigate& n) {
  return {{"place", n.place}, {"path_b", n.path_B}, {"heading_rad", n.heading_rad}, {"gait", n.gait}};
}

json fields_of(const Gaze& g) {
  return {{"target", name_of(g.target)},
          {"square", g.square},
          {"piece", g.piece},
          {"point_b", g.point_B},
          {"hold_s", g.hold_s}};
}

json fields_of(const Say& s) {
  return {{"text", s.text}, {"language", s.language}, {"code", s.code}};
}

json fields_of(const Express& e) {
  return {{"face", e.face}, {"weight", e.weight}, {"hold_s", e.hold_s}};
}

json fields_of(const Stop& s) {
  return {{"commands", s.commands}};
}

json to_json(const ScenePiece& p) {
  return {{"name", p.name}, {"side", name_of(p.side)}, {"king", p.king}, {"real", p.real}, {"p_b", p.p_B}};
}

json to_json(const SceneBox& b) {
  return {{"name", b.name}, {"x_bo", counterpart::to_json(b.X_BO)}, {"size_m", b.size_m}};
}

json stamped(const FrameStamp& stamp) {
  return {{"frame_id", stamp.frame_id}, {"capture_ns", stamp.capture_ns}};
}

template <class T>
json list_of(const std::vector<T>& values) {
  json list = json::array();
  for (const T& value : values) list.push_back(to_json(value));
  return list;
}

}  // namespace

json to_json(const Hello& m) {
  json out{{"version_min", m.version_min},
           {"version_max", m.version_max},
           {"role", name_of(m.role)},
           {"software", m.software},
           {"resume_session", m.resume_session},
           {"last_seq", m.last_seq},
           {"video", m.video},
           {"want_video", m.want_video},
           {"lockstep", m.lockstep}};
  if (m.h264) out["h264"] = true;
  if (m.want_debug) out["want_debug"] = true;
  return out;
}

json to_json(const Welcome& m) {
  return {{"version", m.version}, {"session", m.session},   {"role", name_of(m.role)}, {"software", m.software},
          {"resumed", m.resumed}, {"last_seq", m.last_seq}, {"lockstep", m.lockstep}};
}

json to_json(const ErrorReport& m) {
  return {{"code", m.code}, {"message", m.message}};
}

json to_json(const Bye& m) {
  return {{"reason", m.reason}};
}

json to_json(const Challenge& m) {
  return {{"nonce", hex(m.nonce)}};
}

json to_json(const Proof& m) {
  return {{"nonce", hex(m.nonce)}, {"mac", hex(m.mac)}};
}

json to_json(const Intrinsics& m) {
  return {{"id", m.id}, {"width", m.width}, {"height", m.height}, {"fx", m.fx},
          {"fy", m.fy}, {"cx", m.cx},       {"cy", m.cy},         {"dist", m.dist}};
}

json to_json(const DebugView& m) {
  json out = stamped(m.stamp);
  out["lines"] = m.lines;
  out["points"] = json::array();
  for (const DebugPoint& p : m.points) out["points"].push_back({p.x, p.y, p.verdict});
  out["readings"] = m.readings;
  return out;
}

json to_json(const BoardState& m) {
  return {{"revision", m.revision},
          {"rules", m.rules},
          {"squares", m.squares},
          {"turn", name_of(m.turn)},
          {"virtual_side", name_of(m.virtual_side)},
          {"phase", name_of(m.phase)},
          {"result", name_of(m.result)},
          {"moves", m.moves},
          {"to_remove", m.to_remove},
          {"start_fen", m.start_fen}};
}

json to_json(const GameEvent& m) {
  return {{"id", m.id},
          {"kind", name_of(m.kind)},
          {"side", name_of(m.side)},
          {"code", m.code},
          {"move", m.move},
          {"squares", m.squares},
          {"captured", m.captured},
          {"legal", m.legal},
          {"result", name_of(m.result)},
          {"stamp_ns", m.stamp_ns}};
}

json to_json(const Control& m) {
  return {
      {"id", m.id}, {"kind", name_of(m.kind)}, {"text", m.text}, {"number", m.number}, {"corners_px", m.corners_px}};
}

json to_json(const BoardGeometry& m) {
  return {{"squares", m.squares},
          {"square_size_m", m.square_size_m},
          {"border_m", m.border_m},
          {"thickness_m", m.thickness_m},
          {"piece_radius_m", m.piece_radius_m},
          {"piece_height_m", m.piece_height_m},
          {"played_on", name_of(m.played_on)}};
}

json to_json(const Pose& m) {
  return {{"q", m.q}, {"p", m.p}};
}

json to_json(const Scene& m) {
  return {{"revision", m.revision},
          {"board", to_json(m.board)},
          {"table_height_m", m.table_height_m},
          {"pieces", list_of(m.pieces)},
          {"boxes", list_of(m.boxes)},
          {"light", {{"direction_b", m.light.direction_B}, {"colour", m.light.colour}, {"ambient", m.light.ambient}}},
          {"virtual_side", name_of(m.virtual_side)},
          {"opponent", m.opponent}};
}

json to_json(const Command& m) {
  json out = std::visit([](const auto& action) { return fields_of(action); }, m.action);
  out["id"] = m.id;
  out["verb"] = verb_of(m.action);
  out["after"] = m.after;
  out["delay_ms"] = m.delay_ms;
  out["deadline_ms"] = m.deadline_ms;
  out["interrupt"] = m.interrupt;
  return out;
}

json to_json(const Feedback& m) {
  return {
      {"command_id", m.command_id}, {"state", name_of(m.state)}, {"verb", m.verb}, {"phase", m.phase}, {"code", m.code},
      {"gap_mm", m.gap_mm},         {"stamp_ns", m.stamp_ns}};
}

json to_json(const Heartbeat& m) {
  return {{"queued", m.queued}, {"dropped", m.dropped}};
}

json to_json(const ClockRequest& m) {
  return {{"sent_ns", m.sent_ns}};
}

json to_json(const ClockResponse& m) {
  return {{"sent_ns", m.sent_ns}, {"received_ns", m.received_ns}, {"answered_ns", m.answered_ns}};
}

json to_json(const Acknowledge& m) {
  return {{"seq", m.seq}};
}

json to_json(const PoseEstimate& m) {
  json out = stamped(m.stamp);
  out["object_id"] = m.object_id;
  out["intrinsics_id"] = m.intrinsics_id;
  out["status"] = name_of(m.status);
  out["rms_px"] = m.rms_px;
  out["seen_share"] = m.seen_share;
  out["x_cb"] = to_json(m.X_CB);
  out["covariance"] = m.covariance;
  return out;
}

json to_json(const VideoFrame& m) {
  json out = stamped(m.stamp);
  out["codec"] = name_of(m.codec);
  out["width"] = m.width;
  out["height"] = m.height;
  out["stride"] = m.stride;
  out["size"] = m.bytes.size();
  return out;
}

json to_json(const Mask& m) {
  json out = stamped(m.stamp);
  out["width"] = m.width;
  out["height"] = m.height;
  out["runs"] = m.runs;
  return out;
}

json to_json(const FrameDone& m) {
  return stamped(m.stamp);
}

json to_json(const Message& message) {
  return std::visit([](const auto& m) { return to_json(m); }, message);
}

template <class T>
std::string to_json_text(const T& value) {
  return to_json(value).dump(-1, ' ', false, json::error_handler_t::replace);
}

#define COUNTERPART_TEXT(T) template std::string to_json_text<T>(const T& value)
COUNTERPART_TEXT(Hello);
COUNTERPART_TEXT(Welcome);
COUNTERPART_TEXT(ErrorReport);
COUNTERPART_TEXT(Bye);
COUNTERPART_TEXT(Challenge);
COUNTERPART_TEXT(Proof);
COUNTERPART_TEXT(Intrinsics);
COUNTERPART_TEXT(DebugView);
COUNTERPART_TEXT(BoardState);
COUNTERPART_TEXT(GameEvent);
COUNTERPART_TEXT(Control);
COUNTERPART_TEXT(Scene);
COUNTERPART_TEXT(Command);
COUNTERPART_TEXT(Feedback);
COUNTERPART_TEXT(BoardGeometry);
COUNTERPART_TEXT(Pose);
COUNTERPART_TEXT(PoseEstimate);
COUNTERPART_TEXT(Message);

}  // namespace counterpart
