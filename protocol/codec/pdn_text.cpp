#include "protocol/codec/pdn_text.hpp"

#include <algorithm>

namespace counterpart {
namespace {

constexpr std::size_t line_width = 79;

}  // namespace

std::string pdn_tag(const std::string& name, const std::string& value) {
  std::string text = "[" + name + " \"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return text + "\"]\n";
}

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

std::string pdn_game_type(std::string_view rules) {
  if (rules == "brazilian") return "26,W,8,8,N2,0";
  if (rules == "english") return "21,B,8,8,N1,0";
  return "20";  // stands for 20,W,10,10,N2,0
}

void PdnLines::word(std::string word) {
  if (word.empty()) return;
  if (word.front() == '%' && (column_ == 0 || column_ + 1 + word.size() > line_width)) {
    word.insert(word.begin(), ' ');  // in the first column it would be a comment line
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

void PdnLines::words(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) word(text.substr(at, end - at));
    at = end + 1;
  }
}

}  // namespace counterpart
