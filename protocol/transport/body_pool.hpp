// Memory of message bodies, used again once nobody needs what is in it: a body waits in queues and for its
// acknowledgement, so the oldest is the first to come free. Not thread-safe.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "protocol/codec/bytes.hpp"

namespace counterpart {

class BodyPool {
 public:
  // most: bodies that are kept for their memory.
  explicit BodyPool(std::size_t most) : most_(most) {}

  std::shared_ptr<Bytes> take() {
    if (!lent_.empty() && lent_.front().use_count() == 1) {
      lent_.push_back(std::move(lent_.front()));
      lent_.pop_front();
      return lent_.back();
    }
    auto fresh = std::make_shared<Bytes>();
    if (lent_.size() < most_) lent_.push_back(fresh);
    return fresh;
  }

 private:
  std::size_t most_;
  std::deque<std::shared_ptr<Bytes>> lent_;  // the oldest first
};

}  // namespace counterpart
