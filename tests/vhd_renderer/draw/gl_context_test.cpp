#include "vhd_renderer/draw/gl_context.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

TEST(GlContext, IsMadeHereAndSaysWhatDraws) {
  const auto context = GlContext::create();
  ASSERT_TRUE(context.has_value()) << context.error().message;
  EXPECT_NE((*context)->description().find(": "), std::string::npos);
}

// In a process of its own, because drivers are looked up once a process.
TEST(GlContextDeathTest, SaysWhatIsMissingWithoutADriver) {
  const auto without_driver = [] {
    setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere", 1);
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/none.json", 1);
    const auto context = GlContext::create();
    if (context || context.error().code != ErrorCode::unavailable) std::_Exit(3);
    std::fprintf(stderr, "%s\n", context.error().message.c_str());
    std::_Exit(0);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(without_driver(), testing::ExitedWithCode(0), "No OpenGL 3.3 context.*Install a driver");
}

}  // namespace
}  // namespace counterpart
