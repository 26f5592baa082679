#include "stage/scenario/scenario.hpp"

#include <filesystem>

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

std::string complaint(const std::string& text) {
  const Result<Scenario> scenario = parse_scenario(text);
  EXPECT_FALSE(scenario.has_value());
  return scenario ? "" : scenario.error().message;
}

void expect_mentions(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << message << " lacks " << word;
}

TEST(Scenario, ReadsWhatIsGivenAndKeepsTheRest) {
  const Scenario scenario = parse_scenario(R"({"seed": 9, "camera": {"width": 1280, "height": 720, "orbit_deg": 90},
      "board": {"squares": 8, "piece_diameter_mm": 30}})")
                                .value();
  EXPECT_EQ(scenario.intrinsics.width, 1280);
  EXPECT_DOUBLE_EQ(scenario.intrinsics.cx, 639.5);
  EXPECT_NEAR(scenario.path.orbit_rad, 1.5708, 1e-4);
  EXPECT_EQ(scenario.board.squares, 8);
  EXPECT_DOUBLE_EQ(scenario.board.piece_radius_m, 0.015);
  EXPECT_EQ(scenario.fps, 25);
}

TEST(Scenario, UnknownKeysAreNamedWithTheirLineAndWhatIsKnown) {
  expect_mentions(complaint("{\n \"camera\": {\n  \"nois\": 3\n }\n}"),
                  {"line 3", "camera/nois", "known here", "noise"});
}

TEST(Scenario, ImpossibleValuesAreNamedWithWhatIsAllowed) {
  expect_mentions(complaint("{\n\"camera\": {\"noise\": 400}}"), {"line 2", "camera/noise", "0 to 30", "400"});
  expect_mentions(complaint(R"({"board": {"played_on": "pink"}})"), {"\"dark\", \"light\"", "pink"});
  expect_mentions(complaint(R"({"board": {"squares": 9}})"), {"8 or 10"});
  expect_mentions(complaint(R"({"camera": {"eye_m": [1, 2]}})"), {"array of 3"});
  expect_mentions(complaint("{\"player\": {\"illegal_moves\": [\n{\"at_move\": 1},\n{\"kind\": \"upwards\"}]}}"),
                  {"line 3", "illegal_moves/1/kind", "backwards", "upwards"});
  expect_mentions(complaint("[]"), {"an object"});
}

TEST(Scenario, BrokenJsonNamesItsLine) {
  expect_mentions(complaint("{\n\"seed\": 1,\n}"), {"line 3", "not JSON"});
  EXPECT_EQ(load_scenario("/nowhere/x.json").error().code, ErrorCode::not_found);
}

TEST(Scenario, AllExamplesAreRight) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(COUNTERPART_SOURCE_DIR "/stage/scenarios")) {
    const Result<Scenario> scenario = load_scenario(entry.path().string());
    ASSERT_TRUE(scenario.has_value()) << scenario.error().message;
    EXPECT_EQ(scenario->name + ".json", entry.path().filename().string());
    EXPECT_FALSE(scenario->about.empty());
    ++count;
  }
  EXPECT_GE(count, 2);
}

}  // namespace
}  // namespace counterpart::stage
