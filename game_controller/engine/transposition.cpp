#include "game_controller/engine/transposition.hpp"

#include <algorithm>
#include <bit>
#include <new>

#include <sys/mman.h>

namespace counterpart {
namespace {

constexpr std::size_t huge_page_bytes = std::size_t{2} << 20;

std::uint32_t check_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> 32);
}

}  // namespace

// Each look goes to a random place, so with pages of 4 KiB the processor searched for the page, a quarter of all time.
TranspositionTable::TranspositionTable(std::size_t bytes)
    : count_(std::bit_floor(std::max<std::size_t>(bytes / sizeof(Bucket), 1))), mask_(count_ - 1) {
  const std::size_t size = count_ * sizeof(Bucket);
  const std::size_t alignment = size >= huge_page_bytes ? huge_page_bytes : alignof(Bucket);
  buckets_.reset(static_cast<Bucket*>(std::aligned_alloc(alignment, size)));  // both are powers of two
  if (!buckets_) throw std::bad_alloc();
  if (size >= huge_page_bytes) static_cast<void>(madvise(buckets_.get(), size, MADV_HUGEPAGE));  // a wish, no more
  std::uninitialized_fill_n(buckets_.get(), count_, Bucket{});
}

void TranspositionTable::clear() {
  std::fill_n(buckets_.get(), count_, Bucket{});
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
