#include "vhd_renderer/body/load_figure.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/vhd_renderer/body/figure_check.hpp"
#include "vhd_renderer/body/glb_writer.hpp"
#include "vhd_renderer/body/mannequin.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

class LoadFigure : public ::testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("counterpart-load-figure-" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
};

Figure textured_mannequin() {
  Figure figure = mannequin();
  Texture texture{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 8, 7, 255}};
  figure.textures.push_back(texture);
  figure.parts[0].texture = 0;
  for (std::size_t i = 0; i < figure.parts[0].uvs.size(); ++i) {
    figure.parts[0].uvs[i] = {0.25F, static_cast<float>(i % 5) / 5.F};
  }
  figure.parts[0].morphs.push_back({"smile", {3, 7}, {{0.01F, 0.02F, 0.03F}, {-0.01F, 0, 0.05F}}});
  figure.parts[0].morphs.push_back({"frown", {11}, {{0, 0.02F, 0}}});
  return figure;
}

TEST_F(LoadFigure, ReadsBackWhatWasWritten) {
  const Figure written = textured_mannequin();
  ASSERT_TRUE(write_glb(written, folder / "m.glb"));
  const auto read = load_figure(folder / "m.glb");
  ASSERT_TRUE(read) << read.error().message;
  expect_sound(*read);
  for (const Joint& joint : written.joints) {
    EXPECT_LT((joint_place(*read, joint.name) - joint.X_HJ.translation()).norm(), 1e-4F) << joint.name;
  }
  ASSERT_EQ(read->parts.size(), written.parts.size());
  for (std::size_t p = 0; p < written.parts.size(); ++p) {
    const FigurePart& a = written.parts[p];
    const FigurePart& b = read->parts[p];
    ASSERT_EQ(a.positions_m.size(), b.positions_m.size());
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_LT((a.colour - b.colour).norm(), 1e-4F);
    for (std::size_t v = 0; v < a.positions_m.size(); ++v) {
      ASSERT_LT((a.positions_m[v] - b.positions_m[v]).norm(), 1e-5F);
      ASSERT_LT((a.uvs[v] - b.uvs[v]).norm(), 1e-5F);
      ASSERT_EQ(written.joints[a.joints[v][0]].name, read->joints[b.joints[v][0]].name);
    }
  }
  ASSERT_EQ(read->parts[0].morphs.size(), 2U);
  EXPECT_EQ(read->parts[0].morphs[0].name, "smile");
  EXPECT_EQ(read->parts[0].morphs[0].vertices, (std::vector<std::uint32_t>{3, 7}));
  EXPECT_LT((read->parts[0].morphs[0].offsets_m[1] - Eigen::Vector3f(-0.01F, 0, 0.05F)).norm(), 1e-5F);
  ASSERT_EQ(read->textures.size(), 1U);
  EXPECT_EQ(read->textures[0].rgba, written.textures[0].rgba);
}

TEST_F(LoadFigure, RefusesAFileCutAnywhere) {
  ASSERT_TRUE(write_glb(textured_mannequin(), folder / "m.glb"));
  std::ifstream in(folder / "m.glb", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (const double share : {0.0, 0.00001, 0.01, 0.1, 0.5, 0.9, 0.99999}) {
    const auto size = static_cast<std::size_t>(static_cast<double>(bytes.size()) * share);
    std::ofstream(folder / "cut.glb", std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(size));
    const auto read = load_figure(folder / "cut.glb");
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, ErrorCode::bad_format);
    EXPECT_NE(read.error().message.find("cut.glb"), std::string::npos) << read.error().message;
  }
}

TEST_F(LoadFigure, RefusesAModelWithoutASkeleton) {
  std::ofstream(folder / "cube.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto read = load_figure(folder / "cube.obj");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("skeleton"), std::string::npos) << read.error().message;
  EXPECT_EQ(load_figure(folder / "none.glb").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace counterpart
