#include "tracker_server/pipeline/board_file.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/program.hpp"

namespace counterpart {
namespace {

Result<BoardGeometry> read(const std::string& text) {
  const testing_support::TemporaryFolder folder;
  std::ofstream(folder.path("board.json")) << text;
  return read_board_file(folder.path("board.json"));
}

TEST(BoardFile, TakesTheFieldsThatItNames) {
  const auto board = read(R"({"squares": 8, "square_size_m": 0.05, "played_on": "light"})");
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board->squares, 8);
  EXPECT_EQ(board->square_size_m, 0.05);
  EXPECT_EQ(board->played_on, SquareColour::light);
  EXPECT_EQ(board->border_m, BoardGeometry{}.border_m);
}

TEST(BoardFile, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {R"({"played_on": 3})", "played_on"},
      {R"({"squares": "ten"})", "squares"},
      {R"({"squares": 9})", "8 or 10"},
      {R"({"squares": 1e300})", "squares"},
      {R"({"square_size_m": 0.001})", "0.005"},
      {R"({"border_m": -1})", "border_m"},
      {R"({"square_size": 0.04})", "there is no \"square_size\"; a board has border_m"},
      {"[1]", "JSON object"},
      {"{", "JSON object"},
  };
  for (const auto& [text, part] : wrong) {
    const auto board = read(text);
    ASSERT_FALSE(board) << text;
    EXPECT_NE(board.error().message.find(part), std::string::npos) << text << ": " << board.error().message;
  }
  EXPECT_EQ(read_board_file("/nowhere/board.json").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace counterpart
