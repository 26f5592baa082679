// What is already known of positions, by key. One entry of 16 bytes a slot, four slots a bucket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

namespace counterpart {

enum class Bound : std::uint8_t { none = 0, upper = 1, lower = 2, exact = 3 };

struct Known {
  std::uint32_t check = 0;
  std::int16_t value = 0;
  std::int8_t depth = 0;
  Bound bound = Bound::none;
  std::uint8_t from = 0;  // of the best move; from == to: none (a hint for ordering, not trusted)
  std::uint8_t to = 0;
  std::uint8_t age = 0;
};

class TranspositionTable {
 public:
  // bytes: rounded down to a power of two, at least one bucket.
  explicit TranspositionTable(std::size_t bytes);

  void clear();
  void new_search() { ++age_; }

  // nullptr if the position is not known.
  const Known* find(std::uint64_t key) const;
  // What this search has found out more deeply of the same position stays.
  void keep(std::uint64_t key, Known known);

  // Asks the memory for what `find` will need soon.
  void prefetch(std::uint64_t key) const { __builtin_prefetch(&buckets_[key & mask_]); }

 private:
  static constexpr std::size_t slots = 4;
  struct alignas(64) Bucket {  // a line of the processor's cache: one look at memory a position
    std::array<Known, slots> known;
  };

  struct Free {
    void operator()(Bucket* buckets) const { std::free(buckets); }
  };

  std::size_t count_ = 0;
  std::unique_ptr<Bucket[], Free> buckets_;
  std::uint64_t mask_ = 0;
  std::uint8_t age_ = 0;
};

}  // namespace counterpart
