#include "tracker_server/pipeline/saved_game.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace counterpart {
namespace {

constexpr const char* kGameFile = "game.json";

}  // namespace

Result<void> replace_file(const std::string& file, const std::string& text) {
  const std::string fresh = file + ".new";
  {
    std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
    out << text;
    out.flush();
    if (!out) return failure(ErrorCode::io, "cannot write '" + fresh + "': " + std::strerror(errno));
  }
  std::error_code error;
  std::filesystem::rename(fresh, file, error);
  if (error) return failure(ErrorCode::io, "cannot replace '" + file + "': " + error.message());
  return {};
}

Result<void> save_game(const std::string& folder, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(ErrorCode::io, "cannot make the state folder '" + folder + "': " + error.message());
  return replace_file((std::filesystem::path(folder) / kGameFile).string(), text);
}

Result<std::optional<std::string>> load_game(const std::string& folder) {
  const std::filesystem::path file = std::filesystem::path(folder) / kGameFile;
  if (!std::filesystem::exists(file)) return std::optional<std::string>{};
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return failure(ErrorCode::io, "cannot read the kept game '" + file.string() + "'");
  return std::optional<std::string>{text.str()};
}

}  // namespace counterpart
