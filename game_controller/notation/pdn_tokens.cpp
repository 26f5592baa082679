#include "game_controller/notation/pdn_tokens.hpp"

#include <cctype>

namespace counterpart {

bool is_pdn_blank(char c) {
  return static_cast<unsigned char>(c) <= ' ';
}

namespace {

// Ends a word: blanks and all that begins another token.
bool ends_word(char c) {
  return is_pdn_blank(c) || std::string_view("[]{}()\"/$!?;").find(c) != std::string_view::npos;
}

}  // namespace

Error pdn_error(const TextPlace& place, const std::string& what) {
  return {ErrorCode::bad_format,
          "PDN, line " + std::to_string(place.line) + ", column " + std::to_string(place.column) + ": " + what};
}

char PdnTokens::take() {
  const char c = text_[at_++];
  if (c == '\n') {
    ++place_.line;
    place_.column = 1;
  } else {
    ++place_.column;
  }
  return c;
}

// A line that begins with % is a comment, and so is the rest of a line after a semicolon.
void PdnTokens::skip_blanks_and_comment_lines() {
  while (!at_end()) {
    const char c = text_[at_];
    if (c == ';' || (c == '%' && place_.column == 1)) {
      while (!at_end() && text_[at_] != '\n') take();
    } else if (is_pdn_blank(c)) {
      take();
    } else {
      return;
    }
  }
}

Result<PdnToken> PdnTokens::next() {
  skip_blanks_and_comment_lines();
  PdnToken token;
  token.place = place_;
  if (at_end()) return token;
  const auto single = [&](PdnTokenKind kind) {
    token.kind = kind;
    token.text = take();
    return token;
  };
  switch (text_[at_]) {
    case '[':
      return single(PdnTokenKind::tag_begin);
    case ']':
      return single(PdnTokenKind::tag_end);
    case '(':
      return single(PdnTokenKind::variation_begin);
    case ')':
      return single(PdnTokenKind::variation_end);
    case '"':
      return quoted(token, PdnTokenKind::quoted);
    case '{':
      return comment(token);
    case '/':
      return set_up(token);
    case '}':
      return tl::make_unexpected(pdn_error(place_, "'}' ends a comment that has not begun"));
    default:
      return word(token);
  }
}

Result<PdnToken> PdnTokens::quoted(PdnToken token, PdnTokenKind kind) {
  token.kind = kind;
  take();
  while (!at_end()) {
    char c = take();
    if (c == '"') return token;
    if (c == '\\' && !at_end() && (text_[at_] == '"' || text_[at_] == '\\')) c = take();
    token.text += c;
  }
  return tl::make_unexpected(pdn_error(token.place, "the quotes that begin here do not end"));
}

Result<PdnToken> PdnTokens::comment(PdnToken token) {
  token.kind = PdnTokenKind::comment;
  take();
  while (!at_end()) {
    const char c = take();
    if (c == '}') return token;
    token.text += c;
  }
  return tl::make_unexpected(pdn_error(token.place, "the comment that begins here does not end"));
}

// /FEN "W:W31-50:B1-20"/
Result<PdnToken> PdnTokens::set_up(PdnToken token) {
  take();
  std::string name;
  while (!at_end() && text_[at_] != '"' && text_[at_] != '/' && text_[at_] != '\n') name += take();
  if (name.rfind("FEN", 0) != 0 || at_end() || text_[at_] != '"') {
    return tl::make_unexpected(pdn_error(token.place, "expected a set-up such as /FEN \"W:W31-50:B1-20\"/"));
  }
  auto read = quoted(token, PdnTokenKind::set_up);
  if (!read) return read;
  skip_blanks_and_comment_lines();
  if (at_end() || text_[at_] != '/') return tl::make_unexpected(pdn_error(place_, "expected '/' after the set-up"));
  take();
  return read;
}

PdnToken PdnTokens::word(PdnToken token) {
  const char first = text_[at_];
  if (first == '$' || first == '!' || first == '?') {
    token.kind = PdnTokenKind::glyph;
    token.text = take();
    const auto belongs = [&](char c) {
      return first == '$' ? std::isdigit(static_cast<unsigned char>(c)) != 0 : c == '!' || c == '?';
    };
    while (!at_end() && belongs(text_[at_])) token.text += take();
    return token;
  }
  token.kind = PdnTokenKind::word;
  // 1/2-1/2 is one word although '/' begins a set-up.
  const auto of_half = [&] { return token.text.ends_with('1') && text_.substr(at_, 2) == "/2"; };
  while (!at_end() && (!ends_word(text_[at_]) || of_half())) token.text += take();
  return token;
}

}  // namespace counterpart
