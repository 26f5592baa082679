#include "stage/record/record.hpp"

#include <sstream>

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

using Squares = std::vector<std::string>;

std::string start() {
  return std::string(20, 'b') + std::string(30, 'e');
}

std::string moved(std::string squares, int from, int to) {
  squares.at(static_cast<std::size_t>(from - 1)) = 'e';
  if (to > 0) squares.at(static_cast<std::size_t>(to - 1)) = 'b';
  return squares;
}

// A second of each way in which the pieces stood.
std::string truth_of(const Squares& occupancies) {
  std::string text;
  for (std::size_t i = 0; i < occupancies.size(); ++i) {
    text += R"({"capture_ns": )" + std::to_string(i * 1000000000) + R"(, "holds_piece": false, "occupancy": ")" +
            occupancies[i] + "\"}\n";
  }
  return text;
}

// 1. 32-28 19-23 2. 28x19 14x23: light takes on 23, dark takes back from 14.
const std::string kGame = "[GameType \"20\"]\n1. 32-28 19-23 2. 28x19 14x23 *\n";
Squares real_game() {
  const std::string offered = moved(start(), 19, 23);
  const std::string taken = moved(offered, 23, 0);
  const std::string back = moved(taken, 14, 23);
  return {start(), offered, taken, back};
}

RecordCheck check(const std::string& pdn, const Squares& occupancies) {
  std::istringstream truth(truth_of(occupancies));
  return compare_record(pdn, truth).value();
}

TEST(Record, AgreesWithWhatWasDone) {
  Squares seen = real_game();
  for (int i = 0; i < 4; ++i) seen.push_back(seen.back());
  const RecordCheck result = check(kGame, seen);
  EXPECT_TRUE(result.agrees()) << result.trouble;
  EXPECT_EQ(result.plies, 4);
  EXPECT_EQ(result.real_moves, 2);
}

TEST(Record, WhatIsTakenBackDoesNotCount) {
  Squares seen = real_game();
  seen.insert(seen.begin() + 1, {moved(start(), 20, 30), start(), moved(start(), 3, 0)});
  seen.insert(seen.begin() + 4, start());
  EXPECT_TRUE(check(kGame, seen).agrees());
}

TEST(Record, AnotherMoveThanTheRecordedOneIsNoticed) {
  Squares seen = real_game();
  seen.back() = moved(moved(moved(start(), 19, 23), 23, 0), 13, 23);
  for (int i = 0; i < 4; ++i) seen.push_back(seen.back());
  EXPECT_NE(check(kGame, seen).trouble.find("13"), std::string::npos) << check(kGame, seen).trouble;
}

TEST(Record, AMoveThatIsNotInTheRecordIsNoticedUnlessItIsYoung) {
  const std::string shorter = "[GameType \"20\"]\n1. 32-28 19-23 2. 28x19 *\n";
  Squares seen = real_game();
  EXPECT_TRUE(check(shorter, seen).agrees()) << "made in the last second";
  for (int i = 0; i < 4; ++i) seen.push_back(seen.back());
  EXPECT_FALSE(check(shorter, seen).agrees());
}

TEST(Record, WhatTheLastMoveCapturedMayStillStand) {
  const std::string ends = "[GameType \"20\"]\n1. 32-28 19-23 2. 28x19 0-1\n";
  Squares seen = {start(), moved(start(), 19, 23)};
  for (int i = 0; i < 4; ++i) seen.push_back(seen.back());
  EXPECT_TRUE(check(ends, seen).agrees()) << check(ends, seen).trouble;
  EXPECT_FALSE(check(kGame, seen).agrees()) << "a move of his own is missing, too";
}

TEST(Record, AMoveThatNobodyMadeIsNoticed) {
  Squares seen = real_game();
  seen.pop_back();
  for (int i = 0; i < 4; ++i) seen.push_back(seen.back());
  EXPECT_FALSE(check(kGame, seen).agrees());
}

TEST(Record, PiecesTakenOneAfterTheOtherAreOneChange) {
  const std::string one = moved(start(), 14, 0);
  const std::string two = moved(one, 18, 0);
  EXPECT_EQ(lasting_changes({start(), one, two}), (Squares{start(), two}));
}

TEST(Record, WhatCannotBeReadIsSaid) {
  std::istringstream nonsense("{}\n");
  EXPECT_NE(compare_record(kGame, nonsense).error().message.find("line 1"), std::string::npos);
  std::istringstream small(R"({"capture_ns": 0, "holds_piece": false, "occupancy": "bbe"})");
  EXPECT_NE(compare_record(kGame, small).error().message.find("3 squares"), std::string::npos);
  std::istringstream nothing;
  EXPECT_FALSE(compare_record("1. 32-99", nothing).has_value());
}

}  // namespace
}  // namespace counterpart::stage
