#include "game_controller/notation/pdn_read.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/notation/pdn_tokens.hpp"
#include "protocol/codec/pdn_text.hpp"

namespace counterpart {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;
constexpr std::size_t most_games = 100'000;
constexpr std::size_t most_moves = 5'000;

bool is_number(std::string_view word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
}

bool is_separator(char c) {
  return c == '-' || c == 'x' || c == 'X' || c == ':';
}

// "12.", "12..." and "..." before a move, or alone.
std::string_view without_move_number(std::string_view word) {
  std::size_t i = 0;
  while (i < word.size() && std::isdigit(static_cast<unsigned char>(word[i])) != 0) ++i;
  if (i == word.size()) return {};
  if (word[i] != '.') return word;
  while (i < word.size() && word[i] == '.') ++i;
  return word.substr(i);
}

std::optional<GameResult> result_of(std::string_view word) {
  if (word == "2-0" || word == "1-0") return GameResult::light_wins;
  if (word == "0-2" || word == "0-1") return GameResult::dark_wins;
  if (word == "1-1" || word == "1/2-1/2") return GameResult::draw;
  if (word == "*" || word == "0-0") return GameResult::open;
  return std::nullopt;
}

// Runs of blanks and control characters become one space.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = is_pdn_blank(c);
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  if (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::string glyph_number(const std::string& glyph) {
  constexpr std::string_view signs[] = {"!", "?", "!!", "??", "!?", "?!"};
  for (std::size_t i = 0; i < std::size(signs); ++i) {
    if (glyph == signs[i]) return "$" + std::to_string(i + 1);
  }
  return glyph;
}

class PdnReader {
 public:
  explicit PdnReader(std::string_view text) : tokens_(text) {}

  Result<std::vector<PdnGame>> read() {
    if (auto ok = advance(); !ok) return tl::make_unexpected(ok.error());
    while (token_.kind != PdnTokenKind::end) {
      if (games_.size() >= most_games) {
        return failure(ErrorCode::limit_exceeded, "This PDN has more than 100,000 games; cut it into parts.");
      }
      if (auto ok = game(); !ok) return tl::make_unexpected(ok.error());
    }
    return std::move(games_);
  }

 private:
  Result<void> advance() {
    auto next = tokens_.next();
    if (!next) return tl::make_unexpected(next.error());
    token_ = std::move(*next);
    return {};
  }

  tl::unexpected<Error> wrong(const TextPlace& place, const std::string& what) const {
    return tl::make_unexpected(pdn_error(place, what + " (game " + std::to_string(games_.size() + 1) + ")"));
  }

  Result<void> game() {
    forget_game();
    if (auto ok = tag_section(); !ok) return ok;
    if (auto ok = begin_record(); !ok) return ok;
    while (token_.kind != PdnTokenKind::end && token_.kind != PdnTokenKind::tag_begin && !result_) {
      if (auto ok = move_section_token(); !ok) return ok;
    }
    // What is said after the result belongs to this game still.
    while (token_.kind == PdnTokenKind::comment) {
      if (auto ok = remark(RemarkKind::comment, token_.text); !ok) return ok;
    }
    end_game();
    return {};
  }

  void forget_game() {
    tags_.clear();
    remarks_.clear();
    start_fen_.clear();
    record_.reset();
    result_.reset();
  }

  bool has_tag(std::string_view name) const {
    return std::any_of(tags_.begin(), tags_.end(), [&](const auto& t) { return t.first == name; });
  }

  Result<void> remark(RemarkKind kind, const std::string& text) {
    remarks_.push_back({record_ ? record_->moves().size() : 0, kind, on_one_line(text)});
    return advance();
  }

  // Comments may stand between tags. The same tag a second time begins another game.
  Result<void> tag_section() {
    while (true) {
      if (token_.kind == PdnTokenKind::comment) {
        if (auto ok = remark(RemarkKind::comment, token_.text); !ok) return ok;
        continue;
      }
      if (token_.kind != PdnTokenKind::tag_begin) return {};
      if (auto ok = advance(); !ok) return ok;
      if (token_.kind != PdnTokenKind::word) return wrong(token_.place, "expected the name of a tag after '['");
      const std::string name = token_.text;
      if (has_tag(name)) {
        if (auto ok = begin_record(); !ok) return ok;
        end_game();
        forget_game();
      }
      if (auto ok = advance(); !ok) return ok;
      if (token_.kind != PdnTokenKind::quoted) {
        return wrong(token_.place, "expected the value of the tag " + name + " in quotes");
      }
      if (name == "FEN" && !token_.text.empty()) {
        start_fen_ = token_.text;
        fen_place_ = token_.place;
      }
      if (name == "GameType") type_place_ = token_.place;
      tags_.emplace_back(name, token_.text);
      if (auto ok = advance(); !ok) return ok;
      if (token_.kind != PdnTokenKind::tag_end) return wrong(token_.place, "expected ']' after the tag " + name);
      if (auto ok = advance(); !ok) return ok;
    }
  }

  std::string tag(std::string_view name) const {
    for (const auto& [key, value] : tags_) {
      if (key == name) return value;
    }
    return {};
  }

  Result<const Rules*> rules_named() const {
    const std::string type = tag("GameType");
    const std::string number = type.substr(0, type.find(','));
    if (type.empty()) return &international_rules;
    for (const Rules* rules : {&international_rules, &brazilian_rules, &english_rules}) {
      const std::string own = pdn_game_type(rules->name);
      if (number == own.substr(0, own.find(','))) return rules;
    }
    return wrong(type_place_, "GameType \"" + type.substr(0, 40) +
                                  "\" is not played here; 20 (international), 26 (Brazilian) and 21 (English) are");
  }

  Result<void> begin_record() {
    const auto rules = rules_named();
    if (!rules) return tl::make_unexpected(rules.error());
    Position start = start_position(**rules);
    if (!start_fen_.empty()) {
      const auto read = read_fen(**rules, start_fen_);
      if (!read) return wrong(fen_place_, read.error().message);
      start = *read;
    }
    record_.emplace(**rules, start);
    return {};
  }

  Result<void> move_section_token() {
    switch (token_.kind) {
      case PdnTokenKind::comment:
        return remark(RemarkKind::comment, token_.text);
      case PdnTokenKind::glyph:
        return remark(RemarkKind::glyph, glyph_number(token_.text));
      case PdnTokenKind::variation_begin:
        return variation();
      case PdnTokenKind::set_up:
        return set_up();
      case PdnTokenKind::word:
        return word();
      case PdnTokenKind::variation_end:
        return wrong(token_.place, "')' ends a variation that has not begun");
      default:
        return wrong(token_.place, "expected a move, a result or a comment, not " + token_.text.substr(0, 20));
    }
  }

  // Kept as text, not replayed.
  Result<void> variation() {
    const TextPlace begin = token_.place;
    std::string text;
    int depth = 0;
    do {
      if (token_.kind == PdnTokenKind::end) return wrong(begin, "the variation that begins here does not end");
      if (token_.kind == PdnTokenKind::variation_begin) ++depth;
      if (token_.kind == PdnTokenKind::variation_end) --depth;
      const bool tight = text.empty() || text.back() == '(' || token_.kind == PdnTokenKind::variation_end;
      if (!tight) text += ' ';
      text += token_.kind == PdnTokenKind::comment  ? "{" + token_.text + "}"
              : token_.kind == PdnTokenKind::glyph  ? glyph_number(token_.text)
              : token_.kind == PdnTokenKind::set_up ? "/FEN \"" + token_.text + "\"/"
                                                    : token_.text;
      if (auto ok = advance(); !ok) return ok;
    } while (depth > 0);
    remarks_.push_back({record_->moves().size(), RemarkKind::variation, on_one_line(text)});
    return {};
  }

  // Before the first move it is the start of the game; later it begins another game under the same tags.
  Result<void> set_up() {
    if (!record_->moves().empty()) {
      auto tags = tags_;
      end_game();
      tags_ = std::move(tags);
      remarks_.clear();
    }
    start_fen_ = token_.text;
    fen_place_ = token_.place;
    std::erase_if(tags_, [](const auto& t) { return t.first == "FEN"; });
    tags_.emplace_back("FEN", start_fen_);
    if (auto ok = begin_record(); !ok) return ok;
    return advance();
  }

  Result<void> word() {
    if (const auto result = result_of(token_.text)) {
      result_ = result;
      return advance();
    }
    const TextPlace place = token_.place;
    std::string text(without_move_number(token_.text));
    const bool may_go_on = text.empty() && is_number(token_.text);
    const std::string bare = token_.text;
    if (auto ok = advance(); !ok) return ok;
    // "32 - 28": a number is a move only if a separator follows.
    if (may_go_on && next_is_separator()) text = bare;
    if (text.empty()) return {};
    while (token_.kind == PdnTokenKind::word && (is_separator(text.back()) || next_is_separator())) {
      text += token_.text;
      if (auto ok = advance(); !ok) return ok;
    }
    if (record_->moves().size() >= most_moves) return wrong(place, "the game has more than 5,000 moves");
    const auto move = read_move(record_->rules(), record_->position(), text);
    if (!move) return wrong(place, move.error().message);
    record_->play(*move);
    return {};
  }

  bool next_is_separator() const {
    return token_.kind == PdnTokenKind::word && !token_.text.empty() && is_separator(token_.text.front());
  }

  void end_game() {
    // Many files end every game with * and say the result in the tag.
    GameResult result = result_.value_or(GameResult::open);
    if (result == GameResult::open) result = result_of(tag("Result")).value_or(GameResult::open);
    games_.push_back({tags_, *record_, result, remarks_});
  }

  PdnTokens tokens_;
  PdnToken token_;
  std::vector<PdnGame> games_;

  std::vector<std::pair<std::string, std::string>> tags_;
  std::vector<PdnRemark> remarks_;
  std::string start_fen_;
  TextPlace fen_place_;
  TextPlace type_place_;
  std::optional<Record> record_;
  std::optional<GameResult> result_;
};

}  // namespace

Result<std::vector<PdnGame>> read_pdn(std::string_view text) {
  if (text.size() > most_bytes) {
    return failure(ErrorCode::limit_exceeded, "This PDN is larger than 64 MiB; cut it into parts.");
  }
  return PdnReader(text).read();
}

}  // namespace counterpart
