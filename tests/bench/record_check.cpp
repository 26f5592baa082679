// Does the record of a game on the stage say what was really done?
//   record_check GAME.pdn TRUTH.jsonl
// Exit code 0: it does, 1: it does not, 2: wrong usage or unreadable.
#include <cstdio>
#include <fstream>
#include <sstream>

#include "stage/record/record.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: record_check GAME.pdn TRUTH.jsonl\n");
    return 2;
  }
  std::ifstream pdn(argv[1]), truth(argv[2]);
  std::ostringstream text;
  if (!(text << pdn.rdbuf()) || !truth) {
    std::fprintf(stderr, "record_check: cannot read %s or %s\n", argv[1], argv[2]);
    return 2;
  }
  const auto check = counterpart::stage::compare_record(text.str(), truth);
  if (!check) {
    std::fprintf(stderr, "record_check: %s\n", check.error().message.c_str());
    return 2;
  }
  std::printf("%d moves in the record, %d moves really made by the real player: %s\n", check->plies, check->real_moves,
              check->agrees() ? "they agree" : check->trouble.c_str());
  return check->agrees() ? 0 : 1;
}
