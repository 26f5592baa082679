// The life of commands: accepted, waiting for others and for their body parts, running, ended exactly once.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <unordered_map>
#include <vector>

#include "protocol/vocabulary/command.hpp"

namespace counterpart {

// Parts of the body as bits.
namespace part {
inline constexpr unsigned head = 1, left_arm = 2, right_arm = 4, legs = 8, face = 16, trunk = 32, gaze = 64,
                          voice = 128;
inline constexpr unsigned arms = left_arm | right_arm;
}  // namespace part

// What a command needs: parts for itself alone, parts that have to keep still, and whether one arm of two is enough.
struct Needs {
  unsigned own = 0;
  unsigned still = 0;
  bool either_arm = false;  // own holds both arms; the one that is free will do
};

class CommandQueue {
 public:
  struct Entry {
    Command command;
    Needs needs;
    std::int64_t accepted_ns = 0;
    std::int64_t ready_ns = -1;  // when all of `after` had ended
    bool running = false;
  };

  // Answers a command seen before with what was said last; empty if it is new.
  const Feedback* said_before(std::uint64_t id) const;

  void repeat(const Feedback& feedback) { out_.push_back(feedback); }

  void accept(const Command& command, const Needs& needs, std::int64_t now_ns);

  // Refuses it: one answer, never accepted.
  void refuse(const Command& command, const std::string& code, double gap_mm, std::int64_t now_ns);

  // Starts what may start, in the order of arrival: `start` gets the parts that are free, and may end the command at
  // once. `held` are parts in use without a command.
  using Start = std::function<void(Entry& entry, unsigned free_parts)>;
  void start_ready(std::int64_t now_ns, unsigned held, const Start& start);

  // Commands past their deadline fail, with `on_end` called for those that were running.
  using OnEnd = std::function<void(std::uint64_t id)>;
  void check_deadlines(std::int64_t now_ns, const OnEnd& on_end);

  void progress(std::uint64_t id, const std::string& phase, double gap_mm, std::int64_t now_ns);
  void end(std::uint64_t id, FeedbackState state, const std::string& code, double gap_mm, std::int64_t now_ns);

  std::vector<std::uint64_t> ids() const;  // running and waiting, in order of arrival
  bool is_running(std::uint64_t id) const;

  // Commands that hold or wait for parts that `needs` asks for.
  std::vector<std::uint64_t> in_the_way(const Needs& needs) const;

  std::vector<Feedback> take_feedback();

 private:
  void say(const Feedback& feedback);
  bool ended(std::uint64_t id) const;
  Entry* find(std::uint64_t id);

  std::list<Entry> entries_;
  std::unordered_map<std::uint64_t, Feedback> last_;  // of every command of the last while
  std::deque<std::uint64_t> order_;
  std::vector<Feedback> out_;
};

}  // namespace counterpart
