#include "game_controller/engine/endgame_cache.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

namespace counterpart {
namespace {

constexpr char table_mark[] = "counterpart endgame 2\n";  // before the bytes of a file; 1 was all tables in one file
constexpr int lowest_priority = 19;

std::string letters_of(const Material& m) {
  return std::string(static_cast<std::size_t>(m.light_kings), 'K') +
         std::string(static_cast<std::size_t>(m.light_men), 'm') + "-" +
         std::string(static_cast<std::size_t>(m.dark_kings), 'K') +
         std::string(static_cast<std::size_t>(m.dark_men), 'm');
}

std::optional<EndgameBytes> read_table_file(const std::string& name) {
  std::ifstream in(name, std::ios::binary | std::ios::ate);
  if (!in) return std::nullopt;
  const auto size = static_cast<std::size_t>(in.tellg());
  constexpr std::size_t table_mark_size = sizeof table_mark - 1;
  constexpr std::size_t largest = std::size_t{16} << 20;
  if (size <= table_mark_size || size > largest) return std::nullopt;
  std::string first(table_mark_size, '\0');
  EndgameBytes bytes(size - table_mark_size);
  in.seekg(0);
  in.read(first.data(), static_cast<std::streamsize>(table_mark_size));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in || first != table_mark) return std::nullopt;
  return bytes;
}

// Under another name first: two programs may do this at once.
void write_table_file(const std::string& name, const EndgameBytes& bytes) {
  const std::string part = name + ".part" + std::to_string(::getpid());
  std::error_code ignored;
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out << table_mark;
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out) {
      std::filesystem::remove(part, ignored);
      return;
    }
  }
  std::filesystem::rename(part, name, ignored);
}

}  // namespace

std::string endgame_cache_folder() {
  const char* cache = std::getenv("COUNTERPART_CACHE");
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder =
      cache != nullptr ? cache : std::string(home != nullptr ? home : ".") + "/.cache/counterpart";
  return (folder / "endgames").string();
}

EndgameCache::EndgameCache(const Rules& rules, std::string folder) : tables_(rules), folder_(std::move(folder)) {
  for (const Material& m : endgame_materials(EndgameTables::most_pieces)) {
    read(m);
    if (m != m.turned()) read(m.turned());
  }
}

EndgameCache::~EndgameCache() {
  ending_ = true;
  if (background_.joinable()) background_.join();
}

void EndgameCache::make_all(int most_pieces, const std::function<bool()>& give_up) {
  for (const Material& m : endgame_materials(most_pieces)) {
    if (!make(m, give_up)) return;
  }
}

bool EndgameCache::make(const Material& material, const std::function<bool()>& give_up) {
  if (tables_.has(material)) return true;
  const bool made = tables_.make(material, give_up);
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  for (const Material& m : endgame_materials(EndgameTables::most_pieces)) {
    keep(m);
    if (m != m.turned()) keep(m.turned());
  }
  return made;
}

void EndgameCache::make_in_background(int most_pieces) {
  if (background_.joinable()) return;
  background_ = std::thread([this, most_pieces] {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), lowest_priority);
    make_all(most_pieces, [this] { return ending_.load(); });
  });
}

std::string EndgameCache::file_of(const Material& m) const {
  return (std::filesystem::path(folder_) / (std::string(tables_.rules().name) + "_" + letters_of(m))).string();
}

void EndgameCache::read(const Material& m) {
  if (auto bytes = read_table_file(file_of(m))) static_cast<void>(tables_.add(m, std::move(*bytes)));
}

void EndgameCache::keep(const Material& m) const {
  const EndgameBytes* bytes = tables_.bytes(m);
  std::error_code ignored;
  if (bytes != nullptr && !std::filesystem::exists(file_of(m), ignored)) write_table_file(file_of(m), *bytes);
}

}  // namespace counterpart
