#include "game_controller/programs/check.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

// What `draughts check` says of a file with this text.
struct Checked {
  Result<bool> right;
  std::string said;
};

Checked checked(const std::string& text) {
  const std::string file = ::testing::TempDir() + "counterpart_check_test.json";
  std::ofstream(file) << text;
  std::ostringstream out;
  auto right = check_positions(international_rules, file, 1e9, out);
  std::remove(file.c_str());
  return {right, out.str()};
}

TEST(Check, goes_through_every_position) {
  const auto [right, said] = checked(
      R"({"positions": [{"fen": "W:W31-50:B1-20", "perft": [9, 81, 658]}, {"fen": "W:W28:B", "legal": ["28-22", "28-23"]}]})");
  ASSERT_TRUE(right);
  EXPECT_TRUE(*right);
  EXPECT_NE(said.find("depths 1-3 right"), std::string::npos) << said;
  EXPECT_NE(said.find("2 moves right"), std::string::npos) << said;
}

TEST(Check, finds_what_is_wrong) {
  const auto counts = checked(R"({"positions": [{"fen": "W:W31-50:B1-20", "perft": [9, 80]}]})");
  ASSERT_TRUE(counts.right);
  EXPECT_FALSE(*counts.right);
  EXPECT_NE(counts.said.find("81 counted, 80 expected"), std::string::npos) << counts.said;
  const auto moves = checked(R"({"positions": [{"fen": "W:W28:B", "legal": ["28-22"]}]})");
  ASSERT_TRUE(moves.right);
  EXPECT_FALSE(*moves.right);
}

TEST(Check, refuses_what_is_no_list_of_positions) {
  EXPECT_FALSE(checked("{}").right);
  EXPECT_FALSE(checked("[").right);
  EXPECT_FALSE(checked(R"({"positions": [{"fen": "nonsense", "perft": [1]}]})").right);
}

}  // namespace
}  // namespace counterpart
