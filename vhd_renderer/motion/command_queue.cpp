#include "vhd_renderer/motion/command_queue.hpp"

#include <algorithm>
#include <utility>

#include "protocol/codec/names.hpp"

namespace counterpart {
namespace {

constexpr std::size_t remembered = 20'000;  // commands whose answers are kept for repeats

bool collide(const Needs& a, const Needs& b) {
  // One arm of two: only in the way of somebody who takes both.
  const auto own = [](const Needs& n) { return n.either_arm ? n.own & ~part::arms : n.own; };
  return ((own(a) & (own(b) | b.still)) != 0) || ((own(b) & a.still) != 0);
}

}  // namespace

const Feedback* CommandQueue::said_before(std::uint64_t id) const {
  const auto found = last_.find(id);
  return found == last_.end() ? nullptr : &found->second;
}

void CommandQueue::accept(const Command& command, const Needs& needs, std::int64_t now_ns) {
  entries_.push_back({command, needs, now_ns, -1, false});
  say({command.id, FeedbackState::accepted, std::string(verb_of(command.action)), "", "", -1, now_ns});
}

void CommandQueue::refuse(const Command& command, const std::string& code, double gap_mm, std::int64_t now_ns) {
  say({command.id, FeedbackState::failed, std::string(verb_of(command.action)), "", code, gap_mm, now_ns});
}

void CommandQueue::start_ready(std::int64_t now_ns, unsigned held, const Start& start) {
  Needs taken{held, 0, false};
  for (const Entry& entry : entries_) {
    if (!entry.running) continue;
    taken.own |= entry.needs.own;
    taken.still |= entry.needs.still;
  }
  std::vector<std::uint64_t> waiting;
  for (const Entry& entry : entries_) {
    if (!entry.running) waiting.push_back(entry.command.id);
  }
  for (const std::uint64_t id : waiting) {
    Entry* entry = find(id);
    if (entry == nullptr) continue;  // ended meanwhile, by one before it
    const auto& after = entry->command.after;
    const bool free_to_go = std::all_of(after.begin(), after.end(), [&](std::uint64_t other) { return ended(other); });
    if (free_to_go && entry->ready_ns < 0) entry->ready_ns = now_ns;
    const bool due = free_to_go && now_ns - entry->ready_ns >= entry->command.delay_ms * 1'000'000;
    // One that waits for another command or for its time does not hold up those behind it.
    if (!due) continue;
    const bool arm_free = !entry->needs.either_arm || (taken.own & part::arms) != part::arms;
    if (collide(entry->needs, taken) || !arm_free) {
      if (!entry->needs.either_arm) taken.own |= entry->needs.own;
      taken.still |= entry->needs.still;
      continue;
    }
    entry->running = true;
    say({id, FeedbackState::started, std::string(verb_of(entry->command.action)), "", "", -1, now_ns});
    start(*entry, ~taken.own);
    if (Entry* still = find(id); still != nullptr) {
      taken.own |= still->needs.own;
      taken.still |= still->needs.still;
    }
  }
}

void CommandQueue::check_deadlines(std::int64_t now_ns, const OnEnd& on_end) {
  for (const std::uint64_t id : ids()) {
    const Entry* entry = find(id);
    const std::int64_t deadline = entry->command.deadline_ms;
    if (deadline <= 0 || now_ns - entry->accepted_ns < deadline * 1'000'000) continue;
    const bool running = entry->running;
    if (running) on_end(id);
    end(id, FeedbackState::failed, "deadline", -1, now_ns);
  }
}

void CommandQueue::progress(std::uint64_t id, const std::string& phase, double gap_mm, std::int64_t now_ns) {
  const Entry* entry = find(id);
  if (entry == nullptr) return;
  say({id, FeedbackState::progress, std::string(verb_of(entry->command.action)), phase, "", gap_mm, now_ns});
}

void CommandQueue::end(std::uint64_t id, FeedbackState state, const std::string& code, double gap_mm,
                       std::int64_t now_ns) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.command.id == id; });
  if (at == entries_.end()) return;
  say({id, state, std::string(verb_of(at->command.action)), "", code, gap_mm, now_ns});
  entries_.erase(at);
}

std::vector<std::uint64_t> CommandQueue::ids() const {
  std::vector<std::uint64_t> all;
  for (const Entry& entry : entries_) all.push_back(entry.command.id);
  return all;
}

bool CommandQueue::is_running(std::uint64_t id) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.command.id == id && e.running; });
}

std::vector<std::uint64_t> CommandQueue::in_the_way(const Needs& needs) const {
  std::vector<std::uint64_t> found;
  for (const Entry& entry : entries_) {
    // Somebody who interrupts and takes either arm clears both: he does not wait for the other one.
    const unsigned shared = needs.own & (entry.needs.own | entry.needs.still);
    if (shared != 0 || (needs.still & entry.needs.own) != 0) found.push_back(entry.command.id);
  }
  return found;
}

std::vector<Feedback> CommandQueue::take_feedback() {
  return std::exchange(out_, {});
}

void CommandQueue::say(const Feedback& feedback) {
  const auto [at, fresh] = last_.insert_or_assign(feedback.command_id, feedback);
  if (fresh) order_.push_back(at->first);
  // Old answers are forgotten, but never of commands that are still alive.
  for (std::size_t tries = 0; order_.size() > remembered && tries < 8; ++tries) {
    const std::uint64_t oldest = order_.front();
    order_.pop_front();
    if (find(oldest) != nullptr) {
      order_.push_back(oldest);
    } else {
      last_.erase(oldest);
    }
  }
  out_.push_back(feedback);
}

bool CommandQueue::ended(std::uint64_t id) const {
  return std::none_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.command.id == id; });
}

CommandQueue::Entry* CommandQueue::find(std::uint64_t id) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.command.id == id; });
  return at == entries_.end() ? nullptr : &*at;
}

}  // namespace counterpart
