// A test on two hosts, which share a token. Skipped without root.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program.hpp"
#include "tests/support/two_name_spaces.hpp"

namespace counterpart::testing_support {

using std::chrono::seconds;
using Words = std::vector<std::string>;

class OnTwoHosts : public testing::Test {
 protected:
  // A class that has more to set up asks IsSkipped() first.
  void SetUp() override {
    if (!hosts_.why_not().empty()) GTEST_SKIP() << hosts_.why_not();
    write_private("token", "0123456789abcdef0123456789abcdef\n");
  }

  void write_private(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path(name)) << text;
    std::filesystem::permissions(folder_.path(name), std::filesystem::perms::owner_read);
  }

  std::string token() const { return folder_.path("token"); }

  TemporaryFolder folder_;
  const TwoNameSpaces hosts_;
};

}  // namespace counterpart::testing_support
