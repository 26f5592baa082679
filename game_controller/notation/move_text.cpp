#include "game_controller/notation/move_text.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart {
namespace {

constexpr std::size_t longest_text = 256;

std::string joined(const std::vector<int>& squares, char separator) {
  std::string text;
  for (const int square : squares) {
    if (!text.empty()) text += separator;
    text += std::to_string(square);
  }
  return text;
}

// "28x19x23" -> 28, 19, 23. Empty for anything that is not numbers with - x : between them.
std::vector<int> numbers_of(std::string_view text) {
  std::vector<int> numbers;
  bool in_number = false;
  for (const char c : text) {
    if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
      if (!in_number) numbers.push_back(0);
      in_number = true;
      numbers.back() = std::min(10 * numbers.back() + (c - '0'), 1000);
    } else if (c == '-' || c == 'x' || c == 'X' || c == ':' || c == ' ' || c == '*') {
      in_number = false;
    } else if (c != '!' && c != '?') {
      return {};
    }
  }
  return numbers;
}

std::vector<Move> matching(const Rules& rules, const Position& position, const std::vector<int>& numbers,
                           bool (*fits)(const Rules&, const Position&, const Move&, const std::vector<int>&)) {
  MoveList legal;
  generate(rules, position, legal);
  std::vector<Move> found;
  for (const Move& move : legal) {
    if (square_of_bit(move.from, rules.squares) == numbers.front() && fits(rules, position, move, numbers)) {
      found.push_back(move);
    }
  }
  return found;
}

bool fits_ends(const Rules& rules, const Position&, const Move& move, const std::vector<int>& numbers) {
  return numbers.size() == 2 && square_of_bit(move.to, rules.squares) == numbers[1];
}

bool fits_path(const Rules& rules, const Position& position, const Move& move, const std::vector<int>& numbers) {
  if (numbers.size() < 3 || square_of_bit(move.to, rules.squares) != numbers.back()) return false;
  const auto ways = routes(rules, position, move);
  return std::any_of(ways.begin(), ways.end(), [&](const Route& way) { return way.squares == numbers; });
}

bool fits_hub(const Rules& rules, const Position&, const Move& move, const std::vector<int>& numbers) {
  if (numbers.size() < 3 || square_of_bit(move.to, rules.squares) != numbers[1]) return false;
  std::vector<int> captured(numbers.begin() + 2, numbers.end());
  std::sort(captured.begin(), captured.end());
  return captured == squares_of_bits(move.captured, rules.squares);
}

// Some writers give only the landings that are needed, or mix in captured squares.
bool fits_part(const Rules& rules, const Position& position, const Move& move, const std::vector<int>& numbers) {
  if (numbers.size() < 3 || square_of_bit(move.to, rules.squares) != numbers.back()) return false;
  const auto ways = routes(rules, position, move);
  return std::any_of(ways.begin(), ways.end(), [&](const Route& way) {
    return std::all_of(numbers.begin() + 1, numbers.end() - 1, [&](int square) {
      return std::find(way.squares.begin(), way.squares.end(), square) != way.squares.end() ||
             std::find(way.captured.begin(), way.captured.end(), square) != way.captured.end();
    });
  });
}

}  // namespace

std::string path_text(const Rules& rules, const Position& position, const Move& move) {
  const auto ways = routes(rules, position, move);
  if (ways.empty()) return hub_text(rules, move);
  return joined(ways.front().squares, move.captured == 0 ? '-' : 'x');
}

std::string pdn_text(const Rules& rules, const Position& position, const Move& move) {
  if (move.captured != 0) {
    MoveList legal;
    generate(rules, position, legal);
    const auto same_ends = std::count_if(legal.begin(), legal.end(),
                                         [&](const Move& m) { return m.from == move.from && m.to == move.to; });
    if (same_ends > 1) return path_text(rules, position, move);
  }
  return joined({square_of_bit(move.from, rules.squares), square_of_bit(move.to, rules.squares)},
                move.captured == 0 ? '-' : 'x');
}

std::string hub_text(const Rules& rules, const Move& move) {
  std::vector<int> numbers{square_of_bit(move.from, rules.squares), square_of_bit(move.to, rules.squares)};
  for (const int square : squares_of_bits(move.captured, rules.squares)) numbers.push_back(square);
  return joined(numbers, move.captured == 0 ? '-' : 'x');
}

Result<Move> read_move(const Rules& rules, const Position& position, std::string_view text, MoveStyle style) {
  const std::string shown(text.substr(0, 40));
  const std::vector<int> numbers = text.size() > longest_text ? std::vector<int>{} : numbers_of(text);
  if (numbers.size() < 2) {
    return failure(ErrorCode::bad_format, "\"" + shown + "\" is not a move; a move looks like 32-28 or 28x19.");
  }
  auto first = fits_path;
  auto second = fits_hub;
  if (style == MoveStyle::hub) std::swap(first, second);
  for (const auto fits : {fits_ends, first, second, fits_part}) {
    const auto found = matching(rules, position, numbers, fits);
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
      std::string choices;
      for (const Move& move : found) choices += " " + path_text(rules, position, move);
      return failure(ErrorCode::invalid_argument, "\"" + shown + "\" may mean more than one move:" + choices + ".");
    }
  }
  return failure(ErrorCode::invalid_argument, "\"" + shown + "\" is not a legal move here.");
}

}  // namespace counterpart
