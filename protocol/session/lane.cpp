#include "protocol/session/lane.hpp"

#include <algorithm>
#include <iterator>

namespace counterpart {
namespace {

constexpr std::size_t kMostKept = 65536;
constexpr std::size_t kMostKeptBytes = 64U << 20;

// How many of a latest-wins type (and object) may wait. More than one, so that a pose does not lose the picture it
// belongs to whenever the link hesitates.
std::ptrdiff_t most_waiting(MessageType type) {
  switch (type) {
    case MessageType::pose:
      return 8;
    case MessageType::mask:
      return 4;
    default:
      return 2;
  }
}

// A third of a second: what a link that hesitates delays must not break the chain.
constexpr std::ptrdiff_t kMostChained = 8;

}  // namespace

bool Lane::keeps(MessageType type) const {
  if (is_kept(type)) return true;
  if (!lockstep_) return false;
  return type == MessageType::pose || type == MessageType::video || type == MessageType::mask ||
         type == MessageType::debug;
}

void Lane::push(Outgoing message) {
  if (keeps(message.type)) {
    message.seq = next_seq_++;
    ++kept_count_;
    kept_bytes_ += message.body->size();
  } else if (!drop_for(message)) {
    return;
  }
  waiting_.push_back(std::move(message));
}

// Makes room for it. False: it would be of no use itself, since what it builds on was dropped.
bool Lane::drop_for(const Outgoing& message) {
  const auto alike = [&](const Outgoing& other) {
    return other.seq == 0 && other.type == message.type && other.object == message.object;
  };
  const auto count = std::count_if(waiting_.begin(), waiting_.end(), alike);
  if (message.chain == Chain::none) {
    if (count < most_waiting(message.type)) return true;
    waiting_.erase(std::find_if(waiting_.begin(), waiting_.end(), alike));
    ++dropped_;
    return true;
  }
  if (count < kMostChained) return true;
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), alike), waiting_.end());
  dropped_ += static_cast<std::uint64_t>(count);
  if (message.chain == Chain::begins) return true;
  ++dropped_;
  return false;
}

const Outgoing* Lane::take() {
  if (waiting_.empty()) return nullptr;
  Outgoing& next = waiting_.front();
  const bool kept = next.seq != 0;
  if (kept) {
    last_given_out_ = std::max(last_given_out_, next.seq);
    unacknowledged_.push_back(std::move(next));
  } else {
    passing_ = std::move(next);
  }
  waiting_.pop_front();
  return kept ? &unacknowledged_.back() : &passing_;
}

bool Lane::acknowledge(std::uint64_t seq) {
  if (seq > last_given_out_) return false;
  while (!unacknowledged_.empty() && unacknowledged_.front().seq <= seq) {
    --kept_count_;
    kept_bytes_ -= unacknowledged_.front().body->size();
    unacknowledged_.pop_front();
  }
  return true;
}

bool Lane::resume(std::uint64_t seq) {
  if (!acknowledge(seq)) return false;
  waiting_.insert(waiting_.begin(), std::make_move_iterator(unacknowledged_.begin()),
                  std::make_move_iterator(unacknowledged_.end()));
  unacknowledged_.clear();
  return true;
}

Lane::Arrival Lane::arrived(std::uint64_t seq) {
  if (seq <= last_received_) return Arrival::duplicate;
  if (seq != last_received_ + 1) return Arrival::gap;
  last_received_ = seq;
  return Arrival::fresh;
}

bool Lane::overflowed() const {
  return kept_count_ > kMostKept || kept_bytes_ > kMostKeptBytes;
}

}  // namespace counterpart
