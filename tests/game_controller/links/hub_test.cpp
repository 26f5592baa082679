#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include "game_controller/links/hub_engine.hpp"
#include "game_controller/links/hub_line.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"

namespace counterpart {
namespace {

TEST(HubLine, reads_values_quotes_and_flags) {
  const auto line = read_hub_line("  info depth=3 pv = \"32-28 19-23\" think x=");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->command, "info");
  ASSERT_EQ(line->arguments.size(), 4u);
  EXPECT_EQ(*line->find("depth"), "3");
  EXPECT_EQ(*line->find("pv"), "32-28 19-23");
  EXPECT_EQ(*line->find("think"), "");
  EXPECT_EQ(line->find("nothing"), nullptr);
  EXPECT_EQ(write_hub_line(*line), "info depth=3 pv=\"32-28 19-23\" think=\"\" x=\"\"");
}

TEST(HubLine, refuses_what_does_not_end) {
  const auto line = read_hub_line("id name=\"Scan");
  ASSERT_FALSE(line);
  EXPECT_NE(line.error().message.find("column 9"), std::string::npos);
  EXPECT_FALSE(read_hub_line(std::string(100'000, 'x')));
  EXPECT_TRUE(read_hub_line("")->command.empty());
}

TEST(HubNumber, takes_whole_numbers_in_range_only) {
  EXPECT_EQ(hub_number("1.5", 0, 2), 1.5);
  for (const char* text : {"", "x", "1x", "3", "-1", "nan", "inf"}) EXPECT_FALSE(hub_number(text, 0, 2)) << text;
}

// Counts how often what has been written is sent on.
class CountingBuffer : public std::stringbuf {
 public:
  int flushes = 0;

 protected:
  int sync() override {
    ++flushes;
    return std::stringbuf::sync();
  }
};

// The search writes from a thread of its own: who waits for the next line must keep off the output meanwhile.
TEST(HubEngine, reading_does_not_touch_the_output) {
  CountingBuffer buffer;
  std::ostream out(&buffer);
  std::istringstream in("hub\ninit\nping\nping\n");
  in.tie(&out);
  run_hub_engine(in, out);
  const std::string said = buffer.str();
  EXPECT_EQ(buffer.flushes, std::count(said.begin(), said.end(), '\n')) << said;
  EXPECT_EQ(in.tie(), &out);
}

std::vector<std::string> conversation(const std::string& said) {
  std::istringstream in(said);
  std::ostringstream out;
  run_hub_engine(in, out);
  std::vector<std::string> lines;
  std::istringstream answers(out.str());
  for (std::string line; std::getline(answers, line);) lines.push_back(line);
  return lines;
}

const std::string start = "pos pos=W" + std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w');

TEST(HubEngine, introduces_itself) {
  const auto lines = conversation("hub\ninit\nping\nquit\n");
  ASSERT_GE(lines.size(), 4u);
  EXPECT_EQ(lines.front().substr(0, 19), "id name=Counterpart");
  EXPECT_EQ(lines[lines.size() - 3], "wait");
  EXPECT_EQ(lines[lines.size() - 2], "ready");
  EXPECT_EQ(lines.back(), "pong");
}

TEST(HubEngine, answers_with_a_legal_move_after_the_given_ones) {
  const auto lines =
      conversation("hub\ninit\n" + start + " moves=\"32-28 19-23 28x19x23\"\nlevel depth=4\ngo think\nstop\n");
  ASSERT_EQ(lines.back().substr(0, 10), "done move=");
  const std::string move = lines.back().substr(10, lines.back().find(' ', 10) - 10);
  EXPECT_TRUE(move == "14x23x19" || move == "13x24x19") << move;
}

TEST(HubEngine, every_go_gets_one_done_even_if_stopped_or_pondering) {
  for (const char* way :
       {"go think\nstop\n", "go ponder\nstop\n", "go ponder\nponder-hit\nstop\n", "go analyze\nstop\n"}) {
    const auto lines = conversation("init\n" + start + "\nlevel infinite\n" + way);
    int done = 0;
    for (const std::string& line : lines) done += line.substr(0, 4) == "done" ? 1 : 0;
    EXPECT_EQ(done, 1) << way;
  }
}

TEST(HubEngine, bad_lines_are_answered_and_survived) {
  const auto lines =
      conversation("pos pos=nonsense\ngo think\nunknown a=b\n\xff\xfe\npos pos=\"\nset-param name=level value=99\n" +
                   start + " moves=\"1-50\"\nping\n");
  int errors = 0;
  for (const std::string& line : lines) errors += line.substr(0, 5) == "error" ? 1 : 0;
  EXPECT_EQ(errors, 5);
  EXPECT_EQ(lines.back(), "pong");
}

}  // namespace
}  // namespace counterpart
