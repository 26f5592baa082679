#include "game_controller/engine/transposition.hpp"

#include <algorithm>
#include <bit>

namespace counterpart {
namespace {

std::uint32_t check_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> 32);
}

}  // namespace

TranspositionTable::TranspositionTable(std::size_t bytes) {
  buckets_.resize(std::bit_floor(std::max<std::size_t>(bytes / sizeof(Bucket), 1)));
  mask_ = buckets_.size() - 1;
}

void TranspositionTable::clear() {
  std::fill(buckets_.begin(), buckets_.end(), Bucket{});
  age_ = 0;
}

const Known* TranspositionTable::find(std::uint64_t key) const {
  for (const Known& known : buckets_[key & mask_].known) {
    if (known.bound != Bound::none && known.check == check_of(key)) return &known;
  }
  return nullptr;
}

void TranspositionTable::keep(std::uint64_t key, Known known) {
  known.check = check_of(key);
  known.age = age_;
  Known* chosen = nullptr;
  int least = 1 << 20;
  for (Known& old : buckets_[key & mask_].known) {
    if (old.bound == Bound::none || old.check == known.check) {
      if (old.bound != Bound::none && old.age == age_ && old.depth > known.depth) return;
      chosen = &old;
      break;
    }
    const int worth = old.depth - 8 * static_cast<std::uint8_t>(age_ - old.age);
    if (worth < least) {
      least = worth;
      chosen = &old;
    }
  }
  *chosen = known;
}

}  // namespace counterpart
