// Who may include whom: the table of docs/architecture.md, checked against the sources.
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

struct Rule {
  std::string folder;     // of the source tree
  std::string forbidden;  // a regular expression over what stands between the quotes or brackets
};

std::vector<std::string> offences(const Rule& rule) {
  const std::regex include(R"(^\s*#include\s*["<]([^">]+)[">])");
  const std::regex forbidden("^(" + rule.forbidden + ")");
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(COUNTERPART_SOURCE_DIR) / rule.folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".hpp" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);) {
      if (std::regex_search(line, match, include) && std::regex_search(match[1].first, match[1].second, forbidden)) {
        out.push_back(entry.path().string() + ": " + line);
      }
    }
  }
  return out;
}

TEST(Includes, EachFolderUsesOnlyWhatItMay) {
  const std::string vision = "opencv2/|Eigen/|nlopt";
  const std::string network = "boost/|openssl/";
  const std::vector<Rule> rules{
      {"protocol/codec", vision + "|" + network},
      {"protocol/framing", vision + "|" + network},
      {"protocol/session", vision + "|boost/"},
      {"protocol", "opencv2/|game_controller/|tracker_server/|vhd_renderer/|stage/"},
      {"game_controller", vision + "|tracker_server/|vhd_renderer/|stage/"},
      {"game_controller/rules", network},
      {"game_controller/engine", network},
      {"game_controller/referee", network},
      {"tracker_server", "assimp/|epoxy/|EGL/|vhd_renderer/|stage/"},
      {"vhd_renderer", "game_controller/|tracker_server/|stage/|nlopt"},
      {"stage", "tracker_server/"},
  };
  for (const Rule& rule : rules) {
    for (const std::string& offence : offences(rule))
      ADD_FAILURE() << rule.folder << " may not include this: " << offence;
  }
}

TEST(Includes, TheCheckItselfSeesOffences) {
  EXPECT_FALSE(offences({"tests/system", "gtest/"}).empty());
}

}  // namespace
