#include "game_controller/notation/pdn_write.hpp"

#include <algorithm>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "protocol/codec/pdn_text.hpp"

namespace counterpart {
namespace {

void write_remark(const PdnRemark& remark, PdnLines& lines) {
  lines.words(remark.kind == RemarkKind::comment ? "{" + remark.text + "}" : remark.text);
}

std::string move_section(const Record& record, const std::vector<PdnRemark>& remarks, GameResult result) {
  const Rules& rules = record.rules();
  PdnLines lines;
  auto remark = remarks.begin();
  bool numbered = false;  // the next move needs its number: it is the first one, or something was said before it
  // The first side to move in these rules has the odd plies, so a start with the other side begins with "1...".
  int ply = record.start().turn == rules.first ? 0 : 1;
  for (std::size_t i = 0; i < record.moves().size(); ++i, ++ply) {
    for (; remark != remarks.end() && remark->ply <= i; ++remark) {
      write_remark(*remark, lines);
      numbered = true;
    }
    const std::string number = std::to_string(ply / 2 + 1);
    if (ply % 2 == 0) {
      lines.word(number + ".");
    } else if (i == 0 || numbered) {
      lines.word(number + "...");
    }
    numbered = false;
    lines.word(pdn_text(rules, record.position_before(i), record.moves()[i]));
  }
  for (; remark != remarks.end(); ++remark) write_remark(*remark, lines);
  lines.word(pdn_result(result));
  return lines.text() + "\n";
}

}  // namespace

std::string write_pdn(const PdnTags& tags, const Record& record, GameResult result) {
  const Rules& rules = record.rules();
  std::string text = pdn_tag("Event", tags.event) + pdn_tag("Site", tags.site) + pdn_tag("Date", tags.date) +
                     pdn_tag("Round", tags.round) + pdn_tag("White", tags.light) + pdn_tag("Black", tags.dark) +
                     pdn_tag("Result", pdn_result(result)) + pdn_tag("GameType", pdn_game_type(rules.name));
  if (!(record.start() == start_position(rules))) text += pdn_tag("FEN", write_fen(rules, record.start()));
  return text + "\n" + move_section(record, {}, result);
}

std::string write_pdn(const PdnGame& game) {
  const Rules& rules = game.record.rules();
  constexpr std::string_view roster[] = {"Event", "Site", "Date", "Round", "White", "Black"};
  std::string text;
  for (const std::string_view name : roster) {
    const std::string value = game.tag(name);
    text += pdn_tag(std::string(name), value.empty() ? (name == "Date" ? "????.??.??" : "?") : value);
  }
  text += pdn_tag("Result", pdn_result(game.result)) + pdn_tag("GameType", pdn_game_type(rules.name));
  if (!(game.record.start() == start_position(rules))) text += pdn_tag("FEN", write_fen(rules, game.record.start()));
  for (const auto& [name, value] : game.tags) {
    const bool written = std::find(std::begin(roster), std::end(roster), name) != std::end(roster) ||
                         name == "Result" || name == "GameType" || name == "FEN";
    if (!written) text += pdn_tag(name, value);
  }
  return text + "\n" + move_section(game.record, game.remarks, game.result);
}

}  // namespace counterpart
