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
  const std::size_t buckets = std::bit_floor(std::max<std::size_t>(bytes / (slots * sizeof(Known)), 1));
  entries_.resize(buckets * slots);
  mask_ = buckets - 1;
}

void TranspositionTable::clear() {
  std::fill(entries_.begin(), entries_.end(), Known{});
  age_ = 0;
}

const Known* TranspositionTable::find(std::uint64_t key) const {
  const Known* slot = &entries_[bucket_of(key)];
  for (std::size_t i = 0; i < slots; ++i) {
    if (slot[i].bound != Bound::none && slot[i].check == check_of(key)) return slot + i;
  }
  return nullptr;
}

void TranspositionTable::keep(std::uint64_t key, Known known) {
  known.check = check_of(key);
  known.age = age_;
  Known* slot = &entries_[bucket_of(key)];
  Known* chosen = slot;
  int least = 1 << 20;
  for (std::size_t i = 0; i < slots; ++i) {
    if (slot[i].bound == Bound::none || slot[i].check == known.check) {
      chosen = slot + i;
      break;
    }
    const int worth = slot[i].depth - 8 * static_cast<std::uint8_t>(age_ - slot[i].age);
    if (worth < least) {
      least = worth;
      chosen = slot + i;
    }
  }
  *chosen = known;
}

}  // namespace counterpart
