// Who a character is, as a small JSON description:
//   {"name": "default", "sex": "male", "age_years": 35, "origins": {"caucasian": 1}, "muscle": 0.5, "weight": 0.5,
//    "height": 0.5, "clothes": ["male_casualsuit03", "shoes01"], "hair": "short01", "eyes": "brown",
//    "eyebrows": "eyebrow001"}
// Every member but the name may be left out.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct Character {
  std::string name = "default";
  bool female = false;
  double age_years = 35;                                      // 18 .. 90
  std::map<std::string, double> origins{{"caucasian", 1.0}};  // african, asian, caucasian; used as shares
  double muscle = 0.5;                                        // 0 .. 1, 0.5 is average
  double weight = 0.5;                                        // 0 .. 1
  double height = 0.5;                                        // 0 .. 1
  std::vector<std::string> clothes{"male_casualsuit03", "shoes01"};
  std::string hair = "short01";  // empty: none
  std::string eyes = "brown";
  std::string eyebrows = "eyebrow001";
};

// Fails with the member's name if something cannot be, or names an asset outside the core set that is CC0.
Result<Character> parse_character(std::string_view json_text);

// The descriptions of the opponents that are ready, by name ("default", ...).
const std::map<std::string, std::string>& ready_characters();

// The variant of espeak-ng's voices that goes with an opponent; a man's for whom nothing is known.
std::string voice_of(const std::string& opponent);

}  // namespace counterpart
