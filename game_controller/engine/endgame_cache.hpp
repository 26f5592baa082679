// Endgame tables that outlive the program: kept in the user's cache, a file for each, made when they are first wanted.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "game_controller/engine/endgame.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// $COUNTERPART_CACHE or ~/.cache/counterpart, and in it endgames.
std::string endgame_cache_folder();

class EndgameCache {
 public:
  // Reads what the folder holds; what is damaged there is as if it were not. A folder that cannot be written does no
  // harm: its tables are made each time.
  explicit EndgameCache(const Rules& rules, std::string folder = endgame_cache_folder());
  ~EndgameCache();  // ends what goes on in the background

  const EndgameTables& tables() const { return tables_; }

  // Returns when all tables of so many pieces at most, or of this material and all that it leads to, are there, or
  // give_up says so.
  void make_all(int most_pieces, const std::function<bool()>& give_up = {});
  bool make(const Material& material, const std::function<bool()>& give_up = {});

  // Returns at once; what is missing of so many pieces at most appears in `tables` as it is made, at low priority.
  void make_in_background(int most_pieces);

 private:
  std::string file_of(const Material& material) const;
  void read(const Material& material);
  void keep(const Material& material) const;

  EndgameTables tables_;
  std::string folder_;
  std::atomic<bool> ending_ = false;
  std::thread background_;
};

}  // namespace counterpart
