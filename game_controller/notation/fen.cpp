#include "game_controller/notation/fen.hpp"

#include <cctype>
#include <optional>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {
namespace {

// A reader of one line that remembers where it is.
class FenReader {
 public:
  FenReader(const Rules& rules, std::string_view text) : rules_(rules), text_(text) {}

  Result<Position> read() {
    const auto turn = side();
    if (!turn) return wrong("the side to move, W or B");
    position_.turn = *turn;
    while (skip(':')) {
      blanks();
      if (at_end()) break;
      const auto colour = side();
      if (!colour) return wrong("the colour of the pieces, W or B");
      if (auto read = squares(*colour); !read) return tl::make_unexpected(read.error());
    }
    skip('.');
    blanks();
    if (!at_end()) return wrong("':' or the end");
    return position_;
  }

 private:
  Result<void> squares(Side colour) {
    blanks();
    if (at_end() || peek() == ':' || peek() == '.') return {};
    do {
      if (auto read = range(colour); !read) return read;
    } while (skip(','));
    return {};
  }

  Result<void> range(Side colour) {
    blanks();
    const bool king = skip('K') || skip('k');
    const auto first = number();
    if (!first) return wrong("a square number");
    int last = *first;
    if (skip('-')) {
      if (king && !skip('K')) skip('k');
      const auto end = number();
      if (!end || *end < *first) return wrong("the last square of the range");
      last = *end;
    }
    for (int square = *first; square <= last; ++square) {
      if (!is_square(square, rules_.squares)) {
        return bad("there is no square " + std::to_string(square) + " on this board");
      }
      const Bits bit = square_mask(square, rules_.squares);
      if (((position_.light | position_.dark) & bit) != 0) {
        return bad("square " + std::to_string(square) + " is taken twice");
      }
      (colour == Side::light ? position_.light : position_.dark) |= bit;
      if (king) position_.kings |= bit;
    }
    return {};
  }

  std::optional<Side> side() {
    blanks();
    if (at_end()) return std::nullopt;
    const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(peek())));
    if (c != 'W' && c != 'B') return std::nullopt;
    ++at_;
    return c == 'W' ? Side::light : Side::dark;
  }

  std::optional<int> number() {
    blanks();
    int value = 0;
    std::size_t digits = 0;
    while (!at_end() && std::isdigit(static_cast<unsigned char>(peek())) != 0 && digits < 4) {
      value = 10 * value + (peek() - '0');
      ++at_;
      ++digits;
    }
    if (digits == 0) return std::nullopt;
    return value;
  }

  bool skip(char c) {
    blanks();
    if (at_end() || peek() != c) return false;
    ++at_;
    return true;
  }

  void blanks() {
    while (!at_end() && std::isspace(static_cast<unsigned char>(peek())) != 0) ++at_;
  }

  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return text_[at_]; }

  tl::unexpected<Error> bad(const std::string& what) const {
    std::size_t line = 1;
    std::size_t column = 1;
    for (std::size_t i = 0; i < at_ && i < text_.size(); ++i) {
      column = text_[i] == '\n' ? 1 : column + 1;
      if (text_[i] == '\n') ++line;
    }
    return failure(ErrorCode::bad_format, "FEN, line " + std::to_string(line) + ", column " + std::to_string(column) +
                                              ": " + what + ". A FEN looks like W:W31-50:B1-20.");
  }

  tl::unexpected<Error> wrong(const std::string& expected) const { return bad("expected " + expected); }

  const Rules& rules_;
  std::string_view text_;
  std::size_t at_ = 0;
  Position position_;
};

std::string squares_text(Bits pieces, Bits kings, int n) {
  std::string text;
  for (; pieces != 0; pieces &= pieces - 1) {
    const int bit = lowest(pieces);
    if (!text.empty()) text += ',';
    if ((kings & one(bit)) != 0) text += 'K';
    text += std::to_string(square_of_bit(bit, n));
  }
  return text;
}

}  // namespace

Result<Position> read_fen(const Rules& rules, std::string_view text) {
  while (!text.empty() && text.front() == '"') text.remove_prefix(1);
  while (!text.empty() && text.back() == '"') text.remove_suffix(1);
  return FenReader(rules, text).read();
}

std::string write_fen(const Rules& rules, const Position& p) {
  return std::string(p.turn == Side::light ? "W" : "B") + ":W" + squares_text(p.light, p.kings, rules.squares) + ":B" +
         squares_text(p.dark, p.kings, rules.squares);
}

Result<Position> read_squares(const Rules& rules, std::string_view squares, Side turn) {
  const int n = rules.squares;
  const auto expected = static_cast<std::size_t>(playable_squares(n));
  if (squares.size() != expected) {
    return failure(ErrorCode::bad_format, "A position has " + std::to_string(expected) + " squares, this text has " +
                                              std::to_string(squares.size()) + ".");
  }
  Position position;
  position.turn = turn;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const Bits bit = square_mask(static_cast<int>(i) + 1, n);
    const char c = squares[i];
    if (c == 'w' || c == 'W') {
      position.light |= bit;
    } else if (c == 'b' || c == 'B') {
      position.dark |= bit;
    } else if (c != 'e') {
      return failure(ErrorCode::bad_format, "Square " + std::to_string(i + 1) + " holds '" + std::string(1, c) +
                                                "'; it must be one of w, b, W, B and e (empty).");
    }
    if (c == 'W' || c == 'B') position.kings |= bit;
  }
  return position;
}

std::string write_squares(const Rules& rules, const Position& p) {
  std::string text;
  for (int square = 1; square <= playable_squares(rules.squares); ++square) {
    const Bits bit = square_mask(square, rules.squares);
    const bool king = (p.kings & bit) != 0;
    if ((p.light & bit) != 0) {
      text += king ? 'W' : 'w';
    } else if ((p.dark & bit) != 0) {
      text += king ? 'B' : 'b';
    } else {
      text += 'e';
    }
  }
  return text;
}

Result<Position> read_hub_position(const Rules& rules, std::string_view text) {
  if (text.empty() || (text[0] != 'W' && text[0] != 'B')) {
    return failure(ErrorCode::bad_format, "A Hub position begins with the turn, W or B.");
  }
  return read_squares(rules, text.substr(1), text[0] == 'W' ? Side::light : Side::dark);
}

std::string write_hub_position(const Rules& rules, const Position& position) {
  return (position.turn == Side::light ? "W" : "B") + write_squares(rules, position);
}

Position start_position(const Rules& rules) {
  Position position;
  for (int row = 0; row < rules.rows_of_men; ++row) {
    position.dark |= row_mask(row, rules.squares);
    position.light |= row_mask(rules.squares - 1 - row, rules.squares);
  }
  position.turn = rules.first;
  return position;
}

}  // namespace counterpart
