#include "game_controller/training/lessons_file.hpp"

#include <bit>
#include <cmath>
#include <fstream>

namespace counterpart {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

struct Stored {
  Bits light;
  Bits dark;
  Bits kings;
  float result;  // less than 0: none
  float value;
  std::int32_t game;
  std::uint32_t dark_to_move;
};
static_assert(sizeof(Stored) == 40);

Stored stored(const Lesson& lesson) {
  const Position& p = lesson.position;
  return {p.light, p.dark, p.kings, lesson.result.value_or(-1.0F), lesson.value, lesson.game, p.turn == Side::dark};
}

bool is_sound(const Stored& s) {
  const Bits all = s.light | s.dark;
  return (all & ~Layout<10>::all) == 0 && (s.light & s.dark) == 0 && (s.kings & ~all) == 0 && s.result <= 1 &&
         std::isfinite(s.result) && std::isfinite(s.value) && s.game >= 0 && s.dark_to_move <= 1;
}

Lesson lesson_of(const Stored& s) {
  const Position position{s.light, s.dark, s.kings, s.dark_to_move == 1 ? Side::dark : Side::light};
  return {position, s.result < 0 ? std::nullopt : std::optional<float>(s.result), s.value, s.game};
}

}  // namespace

Result<void> append_lessons(const std::vector<Lesson>& lessons, const std::string& file) {
  std::ofstream out(file, std::ios::binary | std::ios::app);
  for (const Lesson& lesson : lessons) {
    const Stored s = stored(lesson);
    out.write(reinterpret_cast<const char*>(&s), sizeof s);
  }
  out.flush();
  if (!out) return failure(ErrorCode::io, "The lessons could not be written to " + file + ".");
  return {};
}

Result<std::vector<Lesson>> read_lessons(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(ErrorCode::not_found, "There is no file of lessons " + file + ".");
  std::vector<Lesson> lessons;
  Stored s;
  while (in.read(reinterpret_cast<char*>(&s), sizeof s)) {
    if (!is_sound(s)) {
      return failure(ErrorCode::bad_format, file + " is no file of lessons, or damaged: lesson " +
                                                std::to_string(lessons.size() + 1) + " makes no sense.");
    }
    lessons.push_back(lesson_of(s));
  }
  if (in.gcount() != 0) return failure(ErrorCode::bad_format, file + " ends within a lesson.");
  return lessons;
}

}  // namespace counterpart
