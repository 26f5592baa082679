#include "vhd_renderer/body/character.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace counterpart {
namespace {

using nlohmann::json;

// MakeHuman's own assets, CC0 since September 2020; the package also holds community clothes under other terms.
bool is_core_asset(const std::string& name) {
  static constexpr std::array<const char*, 31> core{"male_casualsuit01",
                                                    "male_casualsuit02",
                                                    "male_casualsuit03",
                                                    "male_casualsuit04",
                                                    "male_casualsuit05",
                                                    "male_casualsuit06",
                                                    "male_elegantsuit01",
                                                    "male_worksuit01",
                                                    "female_casualsuit01",
                                                    "female_casualsuit02",
                                                    "female_sportsuit01",
                                                    "female_elegantsuit01",
                                                    "shoes01",
                                                    "shoes02",
                                                    "shoes03",
                                                    "shoes04",
                                                    "shoes05",
                                                    "shoes06",
                                                    "short01",
                                                    "short02",
                                                    "short03",
                                                    "short04",
                                                    "bob01",
                                                    "bob02",
                                                    "long01",
                                                    "ponytail01",
                                                    "Braid01",
                                                    "afro01",
                                                    "HighPolyEyes",
                                                    "Teeth_Base",
                                                    "tongue01"};
  if (name.rfind("eyebrow0", 0) == 0 || name.rfind("eyelashes0", 0) == 0 || name == "Eyelashes01") return true;
  return std::find_if(core.begin(), core.end(), [&](const char* one) { return name == one; }) != core.end();
}

tl::unexpected<Error> wrong(const std::string& what) {
  return failure(ErrorCode::bad_format, "character description: " + what);
}

Result<void> read_number(const json& from, const char* key, double low, double high, double& into) {
  if (!from.contains(key)) return {};
  const json& value = from[key];
  if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high)) {
    return wrong(std::string("\"") + key + "\" has to be a number from " + std::to_string(low) + " to " +
                 std::to_string(high));
  }
  into = value.get<double>();
  return {};
}

Result<void> read_asset(const json& from, const char* key, std::string& into) {
  if (!from.contains(key)) return {};
  if (!from[key].is_string()) return wrong(std::string("\"") + key + "\" has to be a name");
  into = from[key].get<std::string>();
  if (!into.empty() && !is_core_asset(into)) return wrong("\"" + into + "\" is not among the core assets");
  return {};
}

Result<void> read_origins(const json& from, std::map<std::string, double>& into) {
  if (!from.contains("origins")) return {};
  const json& origins = from["origins"];
  if (!origins.is_object() || origins.empty()) return wrong("\"origins\" has to be an object of shares");
  into.clear();
  double sum = 0;
  for (const auto& [name, share] : origins.items()) {
    const bool known = name == "african" || name == "asian" || name == "caucasian";
    if (!known || !share.is_number() || !(share.get<double>() >= 0)) {
      return wrong("\"origins\" knows african, asian and caucasian with shares from 0, not \"" + name + "\"");
    }
    into[name] = share.get<double>();
    sum += share.get<double>();
  }
  if (!(sum > 0) || !std::isfinite(sum)) return wrong("the shares of \"origins\" have no sum");
  for (auto& [name, share] : into) share /= sum;
  return {};
}

Result<void> read_clothes(const json& from, std::vector<std::string>& into) {
  if (!from.contains("clothes")) return {};
  if (!from["clothes"].is_array() || from["clothes"].size() > 16) return wrong("\"clothes\" has to be a list of names");
  into.clear();
  for (const json& one : from["clothes"]) {
    if (!one.is_string() || !is_core_asset(one.get<std::string>())) {
      return wrong("clothes " + one.dump() + " are not among the core assets");
    }
    into.push_back(one.get<std::string>());
  }
  return {};
}

}  // namespace

Result<Character> parse_character(std::string_view json_text) {
  const json from = json::parse(json_text, nullptr, false);
  if (!from.is_object()) return wrong("this is not a JSON object");
  Character c;
  if (from.contains("name")) {
    if (!from["name"].is_string()) return wrong("\"name\" has to be text");
    c.name = from["name"].get<std::string>();
  }
  const bool plain = !c.name.empty() && c.name.size() <= 40 && std::all_of(c.name.begin(), c.name.end(), [](char ch) {
    return (ch >= 'a' && ch <= 'z') || (ch >= '0' && ch <= '9') || ch == '_' || ch == '-';
  });
  if (!plain) return wrong("\"name\" has to be 1 to 40 of a-z, 0-9, _ and -");
  if (from.contains("sex")) {
    if (from["sex"] != "female" && from["sex"] != "male") return wrong("\"sex\" has to be \"female\" or \"male\"");
    c.female = from["sex"] == "female";
    if (c.female) c.clothes = {"female_casualsuit01", "shoes03"};
  }
  for (const auto& done :
       {read_number(from, "age_years", 18, 90, c.age_years), read_number(from, "muscle", 0, 1, c.muscle),
        read_number(from, "weight", 0, 1, c.weight), read_number(from, "height", 0, 1, c.height),
        read_origins(from, c.origins), read_clothes(from, c.clothes), read_asset(from, "hair", c.hair),
        read_asset(from, "eyebrows", c.eyebrows)}) {
    if (!done) return tl::make_unexpected(done.error());
  }
  if (from.contains("eyes")) {
    static constexpr std::array<const char*, 9> colours{"blue",  "bluegreen", "brown", "brownlight", "deepblue",
                                                        "green", "grey",      "ice",   "lightblue"};
    const auto known = std::find_if(colours.begin(), colours.end(), [&](const char* k) { return from["eyes"] == k; });
    if (known == colours.end()) return wrong("\"eyes\" has to be a colour such as brown, blue, green or grey");
    c.eyes = *known;
  }
  return c;
}

const std::map<std::string, std::string>& ready_characters() {
  static const std::map<std::string, std::string> ready{
      {"default", R"({"name": "default", "sex": "male", "age_years": 38, "origins": {"caucasian": 1}, "muscle": 0.55,
        "weight": 0.5, "height": 0.55, "clothes": ["male_casualsuit03", "shoes01"], "hair": "short02",
        "eyes": "brown", "eyebrows": "eyebrow001"})"},
      {"ines", R"({"name": "ines", "sex": "female", "age_years": 28, "origins": {"caucasian": 0.8, "african": 0.2},
        "muscle": 0.5, "weight": 0.45, "height": 0.55, "clothes": ["female_casualsuit01", "shoes03"], "hair": "bob02",
        "eyes": "green", "eyebrows": "eyebrow006"})"},
      {"kenji", R"({"name": "kenji", "sex": "male", "age_years": 72, "origins": {"asian": 1}, "muscle": 0.4,
        "weight": 0.5, "height": 0.45, "clothes": ["male_elegantsuit01", "shoes02"], "hair": "short03",
        "eyes": "brown", "eyebrows": "eyebrow003"})"},
      {"amara", R"({"name": "amara", "sex": "female", "age_years": 47, "origins": {"african": 1}, "muscle": 0.5,
        "weight": 0.58, "height": 0.5, "clothes": ["female_elegantsuit01", "shoes04"], "hair": "afro01",
        "eyes": "brown", "eyebrows": "eyebrow009"})"}};
  return ready;
}

std::string voice_of(const std::string& opponent) {
  const auto ready = ready_characters().find(opponent);
  if (ready == ready_characters().end()) return "m3";
  const auto character = parse_character(ready->second);
  if (!character || !character->female) return character && character->age_years > 60 ? "m7" : "m3";
  return character->age_years > 60 ? "f4" : "f2";
}

}  // namespace counterpart
