#include "game_controller/programs/check.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <ostream>
#include <vector>

#include <nlohmann/json.hpp>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/notation/pdn_read.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

constexpr std::size_t most_bytes = std::size_t{64} << 20;

Result<std::string> text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(ErrorCode::not_found, "There is no file " + file + " that can be read.");
  std::string text;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    if (text.size() > most_bytes) return failure(ErrorCode::limit_exceeded, file + " is larger than 64 MiB.");
  }
  return text;
}

bool counts_agree(const Rules& rules, const Position& position, const json& counts, double most_leaves,
                  std::ostream& out) {
  int depth = 0;
  for (const json& count : counts) {
    ++depth;
    const auto expected = count.get<std::uint64_t>();
    if (static_cast<double>(expected) > most_leaves) {
      out << " (depth " << depth << " and deeper left out)";
      return true;
    }
    const std::uint64_t counted = perft(rules, position, depth);
    if (counted != expected) {
      out << " depth " << depth << ": " << counted << " counted, " << expected << " expected";
      return false;
    }
  }
  out << " depths 1-" << depth << " right";
  return true;
}

bool moves_agree(const Rules& rules, const Position& position, const json& expected, std::ostream& out) {
  MoveList legal;
  generate(rules, position, legal);
  std::vector<std::string> moves;
  for (const Move& move : legal) moves.push_back(pdn_text(rules, position, move));
  auto wanted = expected.get<std::vector<std::string>>();
  std::sort(moves.begin(), moves.end());
  std::sort(wanted.begin(), wanted.end());
  if (moves == wanted) {
    out << " " << moves.size() << " moves right";
    return true;
  }
  out << " found";
  for (const std::string& move : moves) out << " " << move;
  return false;
}

}  // namespace

Result<bool> check_positions(const Rules& rules, const std::string& file, double most_leaves, std::ostream& out) {
  const auto text = text_of(file);
  if (!text) return tl::make_unexpected(text.error());
  try {
    bool all = true;
    const json known = json::parse(*text);  // named: a loop over a member of a temporary would run over what is gone
    for (const json& entry : known.at("positions")) {
      const auto fen = entry.at("fen").get<std::string>();
      const auto position = read_fen(rules, fen);
      if (!position) return tl::make_unexpected(position.error());
      out << (entry.contains("name") ? entry.at("name").get<std::string>() : fen) << ":";
      const bool right = entry.contains("perft") ? counts_agree(rules, *position, entry.at("perft"), most_leaves, out)
                                                 : moves_agree(rules, *position, entry.at("legal"), out);
      out << (right ? "" : " WRONG") << std::endl;
      all = all && right;
    }
    return all;
  } catch (const nlohmann::json::exception& e) {
    return failure(ErrorCode::bad_format, file + " is not a list of positions: " + e.what());
  }
}

Result<void> rewrite_pdn(const std::string& file, std::ostream& out) {
  const auto text = text_of(file);
  if (!text) return tl::make_unexpected(text.error());
  const auto games = read_pdn(*text);
  if (!games) return tl::make_unexpected(games.error());
  for (const PdnGame& game : *games) out << write_pdn(game) << "\n";
  return {};
}

}  // namespace counterpart
