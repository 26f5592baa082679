// A game as a PDN file holds it: the moves and what is said beside them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "game_controller/rules/record.hpp"
#include "protocol/vocabulary/game.hpp"

namespace counterpart {

enum class RemarkKind { comment, variation, glyph };

struct PdnRemark {
  std::size_t ply = 0;  // moves made before it
  RemarkKind kind = RemarkKind::comment;
  std::string text;  // a comment without braces, a variation with its parentheses, a glyph as "$6"

  friend bool operator==(const PdnRemark&, const PdnRemark&) = default;
};

struct PdnGame {
  std::vector<std::pair<std::string, std::string>> tags;  // in order, as written
  Record record;
  GameResult result = GameResult::open;
  std::vector<PdnRemark> remarks;

  // Empty if there is no such tag.
  std::string tag(std::string_view name) const {
    for (const auto& [key, value] : tags) {
      if (key == name) return value;
    }
    return {};
  }
};

}  // namespace counterpart
