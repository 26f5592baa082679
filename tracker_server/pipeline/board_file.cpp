#include "tracker_server/pipeline/board_file.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"

namespace counterpart {

Result<BoardGeometry> read_board_file(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) return failure(ErrorCode::not_found, "cannot read the board's description '" + path.string() + "'");
  const auto bad = [&](const std::string& why) {
    return failure(ErrorCode::bad_format, "'" + path.string() + "': " + why);
  };
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) return bad("not a JSON object");
  const nlohmann::json known = to_json(BoardGeometry{});
  for (const auto& [name, value] : json.items()) {
    if (known.contains(name)) continue;
    std::string names;
    for (const auto& field : known.items()) names += (names.empty() ? "" : ", ") + field.key();
    return bad("there is no \"" + name.substr(0, 40) + "\"; a board has " + names);
  }
  auto board = from_json<BoardGeometry>(json);
  if (!board) return bad(board.error().message);
  if (board->square_size_m < 0.005 || board->square_size_m > 1) return bad("square_size_m must be 0.005 to 1");
  return board;
}

}  // namespace counterpart
