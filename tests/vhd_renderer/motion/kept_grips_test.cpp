#include "vhd_renderer/motion/kept_grips.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "vhd_renderer/body/mannequin.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

class KeptGrips : public testing::Test {
 protected:
  KeptGrips()
      : folder_(fs::temp_directory_path() / ("grips_" + std::to_string(::getpid()) + "_" +
                                             testing::UnitTest::GetInstance()->current_test_info()->name())) {}
  ~KeptGrips() override { fs::remove_all(folder_); }

  Grip grip(const GripTarget& target) const { return grips_kept_in(folder_)(figure_, hand_, target); }
  std::vector<fs::path> files() const {
    return fs::exists(folder_) ? std::vector<fs::path>(fs::directory_iterator(folder_), {}) : std::vector<fs::path>{};
  }

  const fs::path folder_;
  const Figure figure_ = mannequin();
  const HandParts hand_ = anatomy_of(figure_).value().arms[right_side].hand;
};

void expect_same(const Grip& a, const Grip& b) {
  EXPECT_EQ(a.X_WP.matrix(), b.X_WP.matrix());
  EXPECT_EQ(a.residual_mm, b.residual_mm);
  for (std::size_t f = 0; f < 5; ++f) {
    EXPECT_EQ(a.open.fingers[f].flex_rad, b.open.fingers[f].flex_rad);
    EXPECT_EQ(a.closed.fingers[f].flex_rad, b.closed.fingers[f].flex_rad);
    EXPECT_EQ(a.closed.fingers[f].spread_rad, b.closed.fingers[f].spread_rad);
  }
  EXPECT_EQ(a.closed.thumb_turn_W, b.closed.thumb_turn_W);
  EXPECT_EQ(a.open_skin_P, b.open_skin_P);
}

TEST_F(KeptGrips, AreTheFittedOnesToTheLastBit) {
  const GripTarget target;
  const Grip fitted = grip_on_piece(figure_, hand_, target);
  expect_same(grip(target), fitted);
  ASSERT_EQ(files().size(), 1U);
  const auto written = fs::last_write_time(files()[0]);
  expect_same(grip(target), fitted);
  EXPECT_EQ(fs::last_write_time(files()[0]), written) << "read, not fitted again";
}

TEST_F(KeptGrips, OtherPiecesHaveTheirOwn) {
  const GripTarget small{0.0115F, 0.006F, 0.03F};
  grip({});
  expect_same(grip(small), grip_on_piece(figure_, hand_, small));
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(KeptGrips, ADamagedFileIsFittedAnew) {
  const Grip fitted = grip({});
  const fs::path file = files().at(0);
  std::ifstream in(file);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (const std::string& damaged :
       {whole.substr(0, whole.size() / 2), std::string(), std::string("[1,2,3]"), "[1e30" + whole.substr(2),
        "[\"x\"" + whole.substr(whole.find(',')), "[0.5," + whole.substr(1)}) {
    std::ofstream(file) << damaged;
    expect_same(grip({}), fitted);
  }
}

}  // namespace
}  // namespace counterpart
