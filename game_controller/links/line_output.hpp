// Lines for a reader who may be slow, or never read at all: writing them holds nothing up.
#pragma once

#include <deque>
#include <string>

namespace counterpart {

class LineOutput {
 public:
  // Of a pipe, terminal or file that stays open as long as this.
  explicit LineOutput(int descriptor) : descriptor_(descriptor) {}

  // Writes what is taken at once and keeps the rest, at most `most_lines_kept`; the oldest are dropped beyond that.
  void put(std::string line);

  // Writes what is taken at once.
  void flush();

  // Writes the rest for at most so long. Says whether everything has been taken.
  bool finish(double patience_s);

  static constexpr std::size_t most_lines_kept = 10'000;

 private:
  bool takes_more(int timeout_ms) const;
  bool write_some();

  int descriptor_;
  std::deque<std::string> lines_;
  std::size_t written_ = 0;  // of the first line
};

}  // namespace counterpart
