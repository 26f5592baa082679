#include "stage/record/record.hpp"

#include <algorithm>
#include <cstdint>

#include <nlohmann/json.hpp>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/pdn_read.hpp"

namespace counterpart::stage {
namespace {

// Only the dark pieces, kings as men.
std::string dark_men(std::string squares) {
  for (char& square : squares) square = square == 'b' || square == 'B' ? 'b' : 'e';
  return squares;
}

// Pieces have gone and none has come.
bool only_removes(const std::string& before, const std::string& after) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] == 'e' && after[i] != 'e') return false;
  }
  return before != after;
}

struct Seen {
  std::vector<std::string> occupancies;  // whenever no piece was in the hand
  std::vector<std::int64_t> since_ns;
  std::int64_t end_ns = 0;
};

Result<std::vector<BoardMoment>> read_truth(std::istream& truth) {
  std::vector<BoardMoment> moments;
  std::string text;
  for (int number = 1; std::getline(truth, text); ++number) {
    const nlohmann::json line = nlohmann::json::parse(text, nullptr, false);
    if (!line.is_object() || !line.contains("occupancy") || !line["occupancy"].is_string() ||
        !line.contains("capture_ns") || !line["capture_ns"].is_number_integer() || !line.contains("holds_piece") ||
        !line["holds_piece"].is_boolean()) {
      return failure(ErrorCode::bad_format, "The truth, line " + std::to_string(number) +
                                                ": no capture_ns, occupancy and holds_piece; is this a truth.jsonl of "
                                                "`stage`?");
    }
    moments.push_back({line["capture_ns"].get<std::int64_t>(), line["occupancy"].get<std::string>(),
                       line["holds_piece"].get<bool>()});
  }
  return moments;
}

Result<Seen> changes_of(const std::vector<BoardMoment>& moments, std::size_t squares) {
  Seen seen;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const BoardMoment& moment = moments[i];
    const std::string occupancy = dark_men(moment.occupancy);
    if (occupancy.size() != squares) {
      return failure(ErrorCode::bad_format, "The truth, line " + std::to_string(i + 1) + ": " +
                                                std::to_string(occupancy.size()) +
                                                " squares, but the record's game has " + std::to_string(squares));
    }
    seen.end_ns = moment.capture_ns;
    if (moment.holds_piece) continue;
    if (!seen.occupancies.empty() && seen.occupancies.back() == occupancy) continue;
    seen.occupancies.push_back(occupancy);
    seen.since_ns.push_back(seen.end_ns);
  }
  return seen;
}

// How the dark pieces stand at the start and after each of the record's moves.
std::vector<std::string> replayed(const Record& record) {
  const std::size_t plies = record.moves().size();
  std::vector<std::string> result;
  for (std::size_t ply = 0; ply < plies; ++ply) {
    result.push_back(dark_men(write_squares(record.rules(), record.position_before(ply))));
  }
  result.push_back(dark_men(write_squares(record.rules(), record.position())));
  return result;
}

std::string squares_of_pieces(const std::string& occupancy) {
  std::string result;
  for (std::size_t i = 0; i < occupancy.size(); ++i) {
    if (occupancy[i] == 'b') result += (result.empty() ? "" : ",") + std::to_string(i + 1);
  }
  return result;
}

// Empty if both agree.
std::string where_they_part(const std::vector<std::string>& real, const std::vector<std::string>& recorded) {
  const std::size_t both = std::min(real.size(), recorded.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (real[i] == recorded[i]) continue;
    return "After " + std::to_string(i) + " changes of the dark pieces they really stood on " +
           squares_of_pieces(real[i]) + ", by the record on " + squares_of_pieces(recorded[i]) + ".";
  }
  if (real.size() == recorded.size()) return {};
  return "The dark pieces really changed " + std::to_string(real.size() - 1) + " times, by the record " +
         std::to_string(recorded.size() - 1) + " times; up to there both agree.";
}

}  // namespace

std::vector<std::string> lasting_changes(const std::vector<std::string>& occupancies) {
  std::vector<std::string> lasting;
  for (const std::string& occupancy : occupancies) {
    const auto earlier = std::find(lasting.begin(), lasting.end(), occupancy);
    if (earlier != lasting.end()) {
      lasting.erase(earlier + 1, lasting.end());
    } else {
      lasting.push_back(occupancy);
    }
  }
  std::vector<std::string> result;
  for (std::size_t i = 0; i < lasting.size(); ++i) {
    const bool on_the_way = i > 0 && i + 1 < lasting.size() && only_removes(lasting[i - 1], lasting[i]) &&
                            only_removes(lasting[i], lasting[i + 1]);
    if (!on_the_way) result.push_back(lasting[i]);
  }
  return result;
}

Result<RecordCheck> compare_record(std::string_view pdn, std::istream& truth) {
  const Result<std::vector<BoardMoment>> seen = read_truth(truth);
  if (!seen) return tl::make_unexpected(seen.error());
  return compare_record(pdn, *seen);
}

Result<RecordCheck> compare_record(std::string_view pdn, const std::vector<BoardMoment>& moments) {
  const Result<std::vector<PdnGame>> games = read_pdn(pdn);
  if (!games) return failure(games.error().code, "The record: " + games.error().message);
  if (games->empty()) return failure(ErrorCode::bad_format, "The record holds no game.");
  const std::vector<std::string> recorded = replayed(games->back().record);
  const Result<Seen> seen = changes_of(moments, recorded.front().size());
  if (!seen) return tl::make_unexpected(seen.error());

  RecordCheck check;
  check.plies = static_cast<int>(recorded.size()) - 1;
  const std::vector<std::string> by_record = lasting_changes(recorded);
  const std::vector<std::string> real = lasting_changes(seen->occupancies);
  for (std::size_t i = 0; i + 1 < real.size(); ++i) check.real_moves += only_removes(real[i], real[i + 1]) ? 0 : 1;
  check.trouble = where_they_part(real, by_record);
  if (check.agrees()) return check;
  // What the last move has captured may still stand: if the game ends with it, nobody asks for it.
  const std::size_t last = by_record.size() - 1;
  if (last > 0 && only_removes(by_record[last - 1], by_record[last]) &&
      where_they_part(real, {by_record.begin(), by_record.end() - 1}).empty()) {
    check.trouble.clear();
    return check;
  }
  // What has only just been done may not be in the record yet.
  constexpr std::int64_t kYoung_ns = 3'000'000'000;
  std::vector<std::string> older = seen->occupancies;
  while (!check.agrees() && !older.empty() && seen->since_ns[older.size() - 1] + kYoung_ns > seen->end_ns) {
    older.pop_back();
    if (where_they_part(lasting_changes(older), by_record).empty()) check.trouble.clear();
  }
  return check;
}

}  // namespace counterpart::stage
