#include "game_controller/notation/pdn_write.hpp"

#include <algorithm>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"

namespace counterpart {
namespace {

constexpr std::size_t line_width = 79;

std::string tag(const std::string& name, const std::string& value) {
  std::string text = "[" + name + " \"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return text + "\"]\n";
}

class Lines {
 public:
  void word(std::string word) {
    if (word.front() == '%' && (column_ == 0 || column_ + 1 + word.size() > line_width)) {
      word.insert(0, " ");  // in the first column it would be a comment line
    }
    if (column_ > 0 && column_ + 1 + word.size() > line_width) {
      text_ += '\n';
      column_ = 0;
    } else if (column_ > 0) {
      text_ += ' ';
      ++column_;
    }
    text_ += word;
    column_ += word.size();
  }
  void words(const std::string& text) {
    std::size_t at = 0;
    while (at < text.size()) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      if (end > at) word(text.substr(at, end - at));
      at = end + 1;
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t column_ = 0;
};

void write_remark(const PdnRemark& remark, Lines& lines) {
  lines.words(remark.kind == RemarkKind::comment ? "{" + remark.text + "}" : remark.text);
}

std::string move_section(const Record& record, const std::vector<PdnRemark>& remarks, GameResult result) {
  const Rules& rules = record.rules();
  Lines lines;
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

std::string pdn_result(GameResult result) {
  switch (result) {
    case GameResult::light_wins:
      return "2-0";
    case GameResult::dark_wins:
      return "0-2";
    case GameResult::draw:
      return "1-1";
    case GameResult::open:
      break;
  }
  return "*";
}

std::string write_pdn(const PdnTags& tags, const Record& record, GameResult result) {
  const Rules& rules = record.rules();
  std::string text = tag("Event", tags.event) + tag("Site", tags.site) + tag("Date", tags.date) +
                     tag("Round", tags.round) + tag("White", tags.light) + tag("Black", tags.dark) +
                     tag("Result", pdn_result(result)) + tag("GameType", std::string(rules.game_type));
  if (!(record.start() == start_position(rules))) text += tag("FEN", write_fen(rules, record.start()));
  return text + "\n" + move_section(record, {}, result);
}

std::string write_pdn(const PdnGame& game) {
  const Rules& rules = game.record.rules();
  constexpr std::string_view roster[] = {"Event", "Site", "Date", "Round", "White", "Black"};
  std::string text;
  for (const std::string_view name : roster) {
    const std::string value = game.tag(name);
    text += tag(std::string(name), value.empty() ? (name == "Date" ? "????.??.??" : "?") : value);
  }
  text += tag("Result", pdn_result(game.result)) + tag("GameType", std::string(rules.game_type));
  if (!(game.record.start() == start_position(rules))) text += tag("FEN", write_fen(rules, game.record.start()));
  for (const auto& [name, value] : game.tags) {
    const bool written = std::find(std::begin(roster), std::end(roster), name) != std::end(roster) ||
                         name == "Result" || name == "GameType" || name == "FEN";
    if (!written) text += tag(name, value);
  }
  return text + "\n" + move_section(game.record, game.remarks, game.result);
}

}  // namespace counterpart
