// The words of a PDN text.
#pragma once

#include <string>
#include <string_view>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct TextPlace {
  int line = 1;
  int column = 1;
};

// Control characters are blanks, too: files of DOS end with one.
bool is_pdn_blank(char c);

// "PDN, line 3, column 7: ..."
Error pdn_error(const TextPlace& place, const std::string& what);

enum class PdnTokenKind {
  tag_begin,        // [
  tag_end,          // ]
  quoted,           // "text", text without quotes and escapes
  comment,          // {text}
  set_up,           // /FEN "text"/, text
  variation_begin,  // (
  variation_end,    // )
  glyph,            // $6, ! and ? with their like
  word,             // a move, number, result, tag name
  end,
};

struct PdnToken {
  PdnTokenKind kind = PdnTokenKind::end;
  std::string text;
  TextPlace place;
};

class PdnTokens {
 public:
  explicit PdnTokens(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.substr(0, 3) == byte_order_mark) text_.remove_prefix(3);
  }

  [[nodiscard]] Result<PdnToken> next();

 private:
  char take();
  bool at_end() const { return at_ >= text_.size(); }
  void skip_blanks_and_comment_lines();
  Result<PdnToken> quoted(PdnToken token, PdnTokenKind kind);
  Result<PdnToken> comment(PdnToken token);
  Result<PdnToken> set_up(PdnToken token);
  PdnToken word(PdnToken token);

  std::string_view text_;
  std::size_t at_ = 0;
  TextPlace place_;
};

}  // namespace counterpart
