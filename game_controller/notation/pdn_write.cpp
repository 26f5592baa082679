#include "game_controller/notation/pdn_write.hpp"

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
  void word(const std::string& word) {
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
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t column_ = 0;
};

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
  Lines lines;
  // The first side to move in these rules has the odd plies, so a start with the other side begins with "1...".
  int ply = record.start().turn == rules.first ? 0 : 1;
  for (std::size_t i = 0; i < record.moves().size(); ++i, ++ply) {
    const std::string number = std::to_string(ply / 2 + 1);
    if (ply % 2 == 0) {
      lines.word(number + ".");
    } else if (i == 0) {
      lines.word(number + "...");
    }
    lines.word(pdn_text(rules, record.position_before(i), record.moves()[i]));
  }
  lines.word(pdn_result(result));
  return text + "\n" + lines.text() + "\n";
}

}  // namespace counterpart
