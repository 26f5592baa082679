#include "protocol/capture/export.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <ostream>

#include <nlohmann/json.hpp>

#include "protocol/codec/names.hpp"
#include "protocol/codec/pdn_text.hpp"

namespace counterpart {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 rotation(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

constexpr double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

// Column k of R_BC, the camera's axes seen from the board.
std::array<double, 3> camera_axis_B(const Matrix3& R_CB, std::size_t k) {
  return {R_CB[k][0], R_CB[k][1], R_CB[k][2]};
}

nlohmann::json transform_of(const PoseEstimate& pose) {
  const Matrix3 R_CB = rotation(pose.X_CB.q);
  const Point3& t = pose.X_CB.p;
  Point3 p_B{};
  for (std::size_t i = 0; i < 3; ++i) p_B[i] = -(R_CB[0][i] * t[0] + R_CB[1][i] * t[1] + R_CB[2][i] * t[2]);
  // OpenTrackIO's camera looks along +y with z up: x = C's x, y = C's z, z = minus C's y.
  const auto x = camera_axis_B(R_CB, 0), forward = camera_axis_B(R_CB, 2), down = camera_axis_B(R_CB, 1);
  const double tilt = std::asin(std::max(-1.0, std::min(1.0, forward[2])));
  const double pan = std::atan2(-forward[0], forward[1]);
  const double roll = std::atan2(-x[2], -down[2]);
  return {{"translation", {{"x", p_B[0]}, {"y", p_B[1]}, {"z", p_B[2]}}},
          {"rotation", {{"pan", degrees(pan)}, {"tilt", degrees(tilt)}, {"roll", degrees(roll)}}},
          {"id", "camera"}};
}

nlohmann::json lens_of(const Intrinsics& k) {
  // OpenTrackIO measures on the sensor; without its size in millimetres one pixel stands for one unit.
  return {{"pinholeFocalLength", k.fx},
          {"projectionOffset", {{"x", k.cx - (k.width - 1) / 2.0}, {"y", k.cy - (k.height - 1) / 2.0}}},
          {"distortion",
           {{{"model", "Brown-Conrady D-U"},
             {"radial", {k.dist[0], k.dist[1], k.dist[4]}},
             {"tangential", {k.dist[2], k.dist[3]}}}}}};
}

void write_game(const BoardState& board, std::uint64_t round, std::ostream& out) {
  const bool virtual_is_light = board.virtual_side == Side::light;
  const std::string light = virtual_is_light ? "virtual player" : "real player";
  const std::string dark = virtual_is_light ? "real player" : "virtual player";
  out << pdn_tag("Event", "Counterpart") << pdn_tag("Round", std::to_string(round)) << pdn_tag("White", light)
      << pdn_tag("Black", dark) << pdn_tag("Result", pdn_result(board.result))
      << pdn_tag("GameType", pdn_game_type(board.rules));
  const bool dark_begins = !board.start_fen.empty() && board.start_fen[0] == 'B';
  if (!board.start_fen.empty()) out << pdn_tag("FEN", board.start_fen);
  PdnLines lines;
  for (std::size_t i = 0; i < board.moves.size(); ++i) {
    const std::size_t ply = i + (dark_begins ? 1 : 0);
    if (ply % 2 == 0) lines.word(std::to_string(ply / 2 + 1) + ".");
    if (i == 0 && dark_begins) lines.word("1...");
    lines.word(board.moves[i]);
  }
  lines.word(pdn_result(board.result));
  out << '\n' << lines.text() << "\n\n";
}

}  // namespace

std::uint64_t export_csv(SessionReader& reader, std::ostream& out) {
  std::uint64_t lines = 0;
  out << "frame,t_ns,object,tx,ty,tz,qw,qx,qy,qz,status,rms_px\n";
  out.precision(17);
  while (const auto recorded = reader.next()) {
    const auto* pose = std::get_if<PoseEstimate>(&recorded->message);
    if (pose == nullptr) continue;
    out << pose->stamp.frame_id << ',' << pose->stamp.capture_ns << ',' << pose->object_id;
    for (const double p : pose->X_CB.p) out << ',' << p;
    for (const double q : pose->X_CB.q) out << ',' << q;
    out << ',' << name_of(pose->status) << ',' << static_cast<double>(pose->rms_px) << '\n';
    ++lines;
  }
  return lines;
}

std::uint64_t export_pdn(SessionReader& reader, std::ostream& out) {
  std::optional<BoardState> game;
  std::uint64_t games = 0;
  while (const auto recorded = reader.next()) {
    const auto* board = std::get_if<BoardState>(&recorded->message);
    if (board == nullptr) continue;
    // A game that was over or had more than one move, and now begins at none, was another one.
    const bool another = game && board->moves.empty() && game->moves.size() > 1;
    if (another) write_game(*game, ++games, out);
    game = *board;
  }
  if (game) write_game(*game, ++games, out);
  return games;
}

std::uint64_t export_opentrackio(SessionReader& reader, std::ostream& out) {
  std::map<std::uint32_t, Intrinsics> lenses;
  std::uint64_t lines = 0;
  while (const auto recorded = reader.next()) {
    if (const auto* lens = std::get_if<Intrinsics>(&recorded->message)) lenses[lens->id] = *lens;
    const auto* pose = std::get_if<PoseEstimate>(&recorded->message);
    if (pose == nullptr || pose->object_id != 0 || !usable(*pose)) continue;
    nlohmann::json sample{{"protocol", {{"name", "OpenTrackIO"}, {"version", {1, 0, 0}}}},
                          {"sourceNumber", 1},
                          {"tracker", {{"status", name_of(pose->status)}, {"recording", false}}},
                          {"timing",
                           {{"mode", "internal"},
                            {"sampleTimestamp",
                             {{"seconds", pose->stamp.capture_ns / 1'000'000'000},
                              {"nanoseconds", pose->stamp.capture_ns % 1'000'000'000}}},
                            {"sequenceNumber", pose->stamp.frame_id % 65536}}},
                          {"transforms", {transform_of(*pose)}}};
    if (const auto lens = lenses.find(pose->intrinsics_id); lens != lenses.end())
      sample["lens"] = lens_of(lens->second);
    out << sample << '\n';
    ++lines;
  }
  return lines;
}

}  // namespace counterpart
