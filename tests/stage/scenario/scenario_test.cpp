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

TEST(Scenario, ReadsEvents) {
  const Scenario scenario = parse_scenario(R"({"events": [{"kind": "cover", "at_s": 2, "share": 0.7},
      {"kind": "nudge_board", "by_mm": [10, -5], "turn_deg": 90}]})")
                                .value();
  ASSERT_EQ(scenario.events.size(), 2u);
  EXPECT_EQ(scenario.events[0].kind, EventKind::cover);
  EXPECT_DOUBLE_EQ(scenario.events[0].share, 0.7);
  EXPECT_DOUBLE_EQ(scenario.events[1].by_m.y(), -0.005);
  EXPECT_NEAR(scenario.events[1].turn_rad, 1.5708, 1e-4);
  expect_mentions(complaint("{\"events\": [\n{\"kind\": \"fire\"}]}"), {"line 2", "events/0/kind", "lights", "fire"});
  expect_mentions(complaint(R"({"camera": {"shutter_ms": 30, "rolling_ms": 30}})"),
                  {"shutter_ms", "between two frames"});
  expect_mentions(complaint(R"({"camera": {"zoom_range": [1.2, 1.3]}})"), {"zoom_range", "with 1 between"});
}

TEST(Scenario, ReadsObjects) {
  const Scenario scenario = parse_scenario(R"({"objects": [{"kind": "chair", "name": "c1", "at_mm": [500, -1000]},
      {"kind": "box", "size_mm": [100, 200, 300], "by_mm": [10, 0]}]})")
                                .value();
  ASSERT_EQ(scenario.objects.size(), 2u);
  EXPECT_TRUE(scenario.objects[0].on_floor);
  EXPECT_DOUBLE_EQ(scenario.objects[0].place_R_m.y(), -1);
  EXPECT_EQ(scenario.objects[0].size_m, usual_size_m(ObjectKind::chair));
  EXPECT_FALSE(scenario.objects[1].on_floor);
  EXPECT_EQ(scenario.objects[1].name, "object2");
  EXPECT_DOUBLE_EQ(scenario.objects[1].size_m.z(), 0.3);
}

TEST(Scenario, ImpossibleObjectsAreNamedWithWhatIsAllowed) {
  expect_mentions(complaint("{\"objects\": [\n{\"kind\": \"sofa\"}]}"),
                  {"line 2", "objects/0/kind", "\"chair\"", "sofa"});
  expect_mentions(complaint("{\"objects\": [{},\n{\"name\": \"../x\"}]}"), {"line 2", "objects/1/name", "letters"});
  expect_mentions(complaint(R"({"objects": [{"name": "a"}, {"name": "a"}]})"), {"objects/1/name", "no other object"});
  expect_mentions(complaint(R"({"objects": [{"kind": "chair", "size_mm": [50, 50, 50]}]})"),
                  {"objects/0", "no smaller"});
  expect_mentions(complaint(R"({"objects": [{"kind": "chair", "by_mm": [50, 50]}]})"), {"objects/0", "on the floor"});
  expect_mentions(complaint(R"({"objects": [{"size_mm": [50, 50]}]})"), {"array of 3"});
  expect_mentions(complaint(R"({"board": {"present": false}})"), {"without a board", "objects"});
}

// One wrong value for each key: the complaint names line, key and what is allowed.
TEST(Scenario, EveryKeySaysWhatItAllows) {
  const struct {
    std::string object, key, value, allowed;
  } cases[] = {{"", "seed", "-1", "0 to 1000000000"},
               {"", "frames", "0", "1 to 1000000"},
               {"", "light", "2", "0 to 1.5"},
               {"camera", "width", "5000", "160 to 1920"},
               {"camera", "height", "5000", "120 to 1080"},
               {"camera", "fps", "0", "1 to 120"},
               {"camera", "focal_px", "\"long\"", "50 to 10000"},
               {"camera", "distortion", "[0, 0]", "array of 5"},
               {"camera", "target_m", "[0, 0, 99]", "-20 to 20"},
               {"camera", "dolly_to_m", "7", "array of 3"},
               {"camera", "sweep_px_per_frame", "-4", "0 to 200"},
               {"camera", "zoom_range", "[0.1, 1]", "0.2 to 5"},
               {"camera", "orbit_deg", "200", "0 to 180"},
               {"camera", "shake_mm", "-1", "0 to 100"},
               {"camera", "blur_px", "9", "0 to 5"},
               {"camera", "exposure_drift_ev", "9", "0 to 3"},
               {"camera", "white_drift", "1", "0 to 0.5"},
               {"camera", "jpeg_quality", "0", "1 to 100"},
               {"camera", "shutter_ms", "100", "0 to 40"},
               {"camera", "interlaced", "1", "true or false"},
               {"board", "square_mm", "5", "10 to 100"},
               {"board", "thickness_mm", "0", "1 to 60"},
               {"board", "piece_diameter_mm", "1", "5 to 100"},
               {"board", "present", "\"no\"", "true or false"},
               {"player", "speed", "0", "0.1 to 5"},
               {"player", "figure", "3", "a text"},
               {"player", "forgets_s", "-1", "0 to 600"},
               {"player", "knocks_over", "[0]", "1 to 500"},
               {"player", "hand_rests", "{}", "an array"}};
  for (const auto& wrong : cases) {
    const std::string pair = "\n\"" + wrong.key + "\": " + wrong.value;
    const bool top = wrong.object.empty();
    expect_mentions(complaint(top ? "{" + pair + "}" : "{\"" + wrong.object + "\": {" + pair + "}}"),
                    {"line 2", wrong.key, wrong.allowed});
  }
}

TEST(Scenario, BrokenJsonNamesItsLine) {
  expect_mentions(complaint("{\n\"seed\": 1,\n}"), {"line 3", "not JSON"});
  EXPECT_EQ(load_scenario("/nowhere/x.json").error().code, ErrorCode::not_found);
}

TEST(Scenario, AllExamplesAreRight) {
  for (const std::string folder : {"/stage/scenarios", "/tests/bench/suite"}) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(COUNTERPART_SOURCE_DIR + folder)) {
      const Result<Scenario> scenario = load_scenario(entry.path().string());
      ASSERT_TRUE(scenario.has_value()) << scenario.error().message;
      EXPECT_EQ(scenario->name + ".json", entry.path().filename().string());
      EXPECT_FALSE(scenario->about.empty());
      ++count;
    }
    EXPECT_GE(count, 14) << folder;
  }
}

}  // namespace
}  // namespace counterpart::stage
