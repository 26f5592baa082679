#include "game_controller/links/dxp_message.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace counterpart {
namespace {

constexpr std::size_t name_width = 32;
constexpr std::size_t board_squares = 50;
constexpr int most_captured = 20;

class DxpReader {
 public:
  explicit DxpReader(std::string_view text) : text_(text) {}

  Result<DxpMessage> read() {
    if (text_.empty() || text_.size() > longest_dxp_message) {
      return failure(ErrorCode::bad_format,
                     "A DXP message has 1 to 127 characters, this one " + std::to_string(text_.size()) + ".");
    }
    const auto message = body(take(1)[0]);
    if (!message) return bad(expected_);
    if (at_ != text_.size() && !std::holds_alternative<DxpChat>(*message)) return bad("the end of the message");
    return *message;
  }

 private:
  std::optional<DxpMessage> body(char kind) {
    switch (kind) {
      case 'R':
        return request();
      case 'A':
        return accept();
      case 'M':
        return move();
      case 'E':
        return end();
      case 'C':
        return DxpChat{std::string(text_.substr(1))};
      case 'B':
        return back_request();
      case 'K': {
        const auto code = number(1, "a code");
        return code ? std::optional<DxpMessage>(DxpBackAccept{*code}) : std::nullopt;
      }
      default:
        at_ = 0;
        expected_ = "one of the letters R, A, M, E, C, B and K";
        return std::nullopt;
    }
  }

  std::optional<DxpMessage> request() {
    DxpGameRequest r;
    const auto version = number(2, "a version");
    if (!version) return std::nullopt;
    const auto who = name();
    const auto side_asked = who ? side() : std::nullopt;
    const auto minutes = side_asked ? number(3, "minutes") : std::nullopt;
    const auto moves = minutes ? number(3, "a number of moves") : std::nullopt;
    if (!moves) return std::nullopt;
    r.name = *who;
    r.follower_side = *side_asked;
    r.minutes = *minutes;
    r.moves = *moves;
    const std::string kind = take(1);
    if (kind == "A") return r;
    if (kind != "B") return expect("A for the usual start or B for another position");
    const auto turn = side();
    if (!turn) return std::nullopt;
    r.position = *turn == Side::light ? "W" : "B";
    for (std::size_t i = 0; i < board_squares; ++i) {
      const std::string piece = take(1);
      if (piece.empty() || std::string_view("wzWZe").find(piece[0]) == std::string_view::npos) {
        return expect("one of w, z, W, Z and e");
      }
      r.position += piece == "z" ? "b" : piece == "Z" ? "B" : piece;
    }
    return r;
  }

  std::optional<DxpMessage> accept() {
    const auto who = name();
    const auto code = who ? number(1, "a code") : std::nullopt;
    return code ? std::optional<DxpMessage>(DxpGameAccept{*who, *code}) : std::nullopt;
  }

  std::optional<DxpMessage> move() {
    const auto seconds = number(4, "seconds");
    const auto from = seconds ? number(2, "a square") : std::nullopt;
    const auto to = from ? number(2, "a square") : std::nullopt;
    const auto count = to ? number(2, "a number of captured pieces") : std::nullopt;
    if (!count) return std::nullopt;
    if (*count > most_captured) return expect("at most 20 captured pieces");
    DxpMove m{*seconds, *from, *to, {}};
    for (int i = 0; i < *count; ++i) {
      const auto square = number(2, "the square of a captured piece");
      if (!square) return std::nullopt;
      m.captured.push_back(*square);
    }
    return m;
  }

  std::optional<DxpMessage> end() {
    const auto reason = number(1, "a reason");
    const auto stop = reason ? number(1, "0 or 1") : std::nullopt;
    return stop ? std::optional<DxpMessage>(DxpGameEnd{*reason, *stop != 0}) : std::nullopt;
  }

  std::optional<DxpMessage> back_request() {
    const auto at = number(3, "the number of a move");
    const auto who = at ? side() : std::nullopt;
    return who ? std::optional<DxpMessage>(DxpBackRequest{*at, *who}) : std::nullopt;
  }

  std::string take(std::size_t n) {
    const std::string taken(text_.substr(std::min(at_, text_.size()), n));
    at_ += taken.size();
    return taken;
  }

  std::optional<int> number(std::size_t digits, const char* what) {
    int value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      if (at_ >= text_.size() || std::isdigit(static_cast<unsigned char>(text_[at_])) == 0) {
        expected_ = std::string(what) + " of " + std::to_string(digits) + (digits == 1 ? " digit" : " digits");
        return std::nullopt;
      }
      value = 10 * value + (text_[at_++] - '0');
    }
    return value;
  }

  std::optional<std::string> name() {
    if (text_.size() - at_ < name_width) {
      expected_ = "a name of 32 characters";
      return std::nullopt;
    }
    std::string text = take(name_width);
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }

  std::optional<Side> side() {
    const std::string letter = take(1);
    if (letter == "W") return Side::light;
    if (letter == "Z") return Side::dark;
    at_ -= letter.size();
    expected_ = "the colour W or Z";
    return std::nullopt;
  }

  std::optional<DxpMessage> expect(const char* what) {
    expected_ = what;
    return std::nullopt;
  }

  tl::unexpected<Error> bad(const std::string& expected) const {
    return failure(ErrorCode::bad_format, "DXP, column " + std::to_string(at_ + 1) + ": expected " + expected + ".");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string expected_;
};

std::string digits(int value, std::size_t width) {
  int most = 1;
  for (std::size_t i = 0; i < width; ++i) most *= 10;
  std::string text = std::to_string(std::clamp(value, 0, most - 1));
  return std::string(width - text.size(), '0') + text;
}

std::string letter(Side side) {
  return side == Side::light ? "W" : "Z";
}

std::string plain(std::string text, std::size_t longest) {
  if (text.size() > longest) text.resize(longest);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
  return text;
}

std::string name_field(const std::string& name) {
  std::string field = plain(name, name_width);
  field.resize(name_width, ' ');
  return field;
}

struct DxpWriter {
  std::string operator()(const DxpGameRequest& r) const {
    std::string text = "R01" + name_field(r.name) + letter(r.follower_side) + digits(r.minutes, 3) + digits(r.moves, 3);
    if (r.position.empty()) return text + "A";
    std::string board = r.position;
    for (char& c : board) c = c == 'b' ? 'z' : c == 'B' ? 'Z' : c;
    return text + "B" + board;
  }
  std::string operator()(const DxpGameAccept& a) const { return "A" + name_field(a.name) + digits(a.code, 1); }
  std::string operator()(const DxpMove& m) const {
    std::string text = "M" + digits(m.seconds, 4) + digits(m.from, 2) + digits(m.to, 2) +
                       digits(static_cast<int>(m.captured.size()), 2);
    for (const int square : m.captured) text += digits(square, 2);
    return text;
  }
  std::string operator()(const DxpGameEnd& e) const { return "E" + digits(e.reason, 1) + (e.stop ? "1" : "0"); }
  std::string operator()(const DxpChat& c) const { return "C" + plain(c.text, longest_dxp_message - 1); }
  std::string operator()(const DxpBackRequest& b) const { return "B" + digits(b.move, 3) + letter(b.side); }
  std::string operator()(const DxpBackAccept& k) const { return "K" + digits(k.code, 1); }
};

}  // namespace

Result<DxpMessage> read_dxp(std::string_view text) {
  while (!text.empty() && (text.front() == '\n' || text.front() == '\r')) text.remove_prefix(1);
  return DxpReader(text).read();
}

std::string write_dxp(const DxpMessage& message) {
  return std::visit(DxpWriter{}, message);
}

}  // namespace counterpart
