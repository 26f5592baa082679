#include "game_controller/links/line_output.hpp"

#include <csignal>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace counterpart {
namespace {

struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() { EXPECT_EQ(::pipe(ends), 0); }
  ~Pipe() {
    close_reader();
    ::close(ends[1]);
  }
  void close_reader() {
    if (ends[0] >= 0) ::close(ends[0]);
    ends[0] = -1;
  }
  std::string read_once() const {
    std::string text(1 << 20, '\0');
    const auto n = ::read(ends[0], text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }
};

std::string line_number(int i) {
  return std::to_string(i) + std::string(90, '.');
}

// A pipe takes 64 KiB: 1,000 results of games that nobody reads are more. If this blocks, the test runs out of time.
TEST(LineOutput, goes_on_when_nobody_reads_and_loses_nothing) {
  constexpr int lines = 1'000;
  Pipe pipe;
  LineOutput output(pipe.ends[1]);
  for (int i = 0; i < lines; ++i) output.put(line_number(i));
  EXPECT_FALSE(output.finish(0.05));
  std::string expected;
  for (int i = 0; i < lines; ++i) expected += line_number(i) + "\n";
  std::string read;
  while (read.size() < expected.size()) {
    const std::string more = pipe.read_once();
    ASSERT_FALSE(more.empty());
    read += more;
    output.flush();
  }
  EXPECT_TRUE(output.finish(0));
  EXPECT_EQ(read, expected);
}

TEST(LineOutput, drops_the_oldest_whole_lines_when_there_are_too_many) {
  Pipe pipe;
  LineOutput output(pipe.ends[1]);
  const int lines = static_cast<int>(LineOutput::most_lines_kept) + 2'000;
  for (int i = 0; i < lines; ++i) output.put(line_number(i));
  std::string read;
  while (!output.finish(0)) read += pipe.read_once();
  read += pipe.read_once();
  std::size_t at = 0;
  std::string last;
  while (at < read.size()) {
    const auto end = read.find('\n', at);
    ASSERT_NE(end, std::string::npos);
    last = read.substr(at, end - at);
    EXPECT_EQ(last, line_number(std::stoi(last)));
    at = end + 1;
  }
  EXPECT_EQ(last, line_number(lines - 1));
}

TEST(LineOutput, says_when_the_reader_is_gone) {
  std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  pipe.close_reader();
  LineOutput output(pipe.ends[1]);
  output.put("nobody");
  EXPECT_FALSE(output.finish(0.05));
}

}  // namespace
}  // namespace counterpart
