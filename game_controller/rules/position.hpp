// A position is a value: who stands where and who is to move.
#pragma once

#include "game_controller/rules/layout.hpp"
#include "protocol/vocabulary/game.hpp"

namespace counterpart {

struct Position {
  Bits light = 0;  // men and kings
  Bits dark = 0;
  Bits kings = 0;  // of both sides, a subset of light | dark
  Side turn = Side::light;

  friend bool operator==(const Position&, const Position&) = default;
};

constexpr Bits pieces_of(const Position& position, Side side) {
  return side == Side::light ? position.light : position.dark;
}

constexpr Bits own(const Position& position) {
  return pieces_of(position, position.turn);
}

constexpr Bits foe(const Position& position) {
  return pieces_of(position, other(position.turn));
}

// A well-mixed 64-bit key; equal positions have equal keys.
constexpr std::uint64_t key_of(const Position& position) {
  std::uint64_t h = position.light * 0x9E3779B97F4A7C15u;
  h ^= std::rotl(position.dark * 0xC2B2AE3D27D4EB4Fu, 29);
  h ^= std::rotl(position.kings * 0x165667B19E3779F9u, 47);
  h += position.turn == Side::light ? 0 : 0xD6E8FEB86659FD93u;
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93u;
  h ^= h >> 29;
  h *= 0x9E3779B97F4A7C15u;
  h ^= h >> 32;
  return h;
}

}  // namespace counterpart
