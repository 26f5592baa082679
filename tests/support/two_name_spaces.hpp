// Two network namespaces that stand for two hosts; gone when this object dies. Needs root.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "tests/support/program.hpp"

namespace counterpart::testing_support {

inline Outcome ip(const std::vector<std::string>& arguments) {
  return run("/sbin/ip", arguments);
}

class TwoNameSpaces {
 public:
  TwoNameSpaces() {
    if (::geteuid() != 0) {
      why_not_ = "network namespaces need root";
    } else if (!std::filesystem::exists("/sbin/ip")) {
      why_not_ = "the program ip (package iproute2) is missing";
    } else {
      add();
    }
  }

  TwoNameSpaces(const TwoNameSpaces&) = delete;
  TwoNameSpaces& operator=(const TwoNameSpaces&) = delete;

  ~TwoNameSpaces() {
    for (const std::string& host : added_) ip({"netns", "delete", host});
  }

  const std::string& why_not() const { return why_not_; }  // empty: they are there

  std::string tracker_host() const { return "cp_a" + std::to_string(::getpid()); }
  std::string renderer_host() const { return "cp_b" + std::to_string(::getpid()); }

  // Arguments for /sbin/ip that run a program of this project on a host.
  static std::vector<std::string> on(const std::string& host, const std::string& program,
                                     const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"netns", "exec", host, COUNTERPART_BIN_DIR "/" + program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return words;
  }

 private:
  void add() {
    for (const std::string& host : {tracker_host(), renderer_host()}) {
      const Outcome outcome = ip({"netns", "add", host});
      if (outcome.exit_code != 0) {
        why_not_ = "network namespaces are not permitted here: " + outcome.err;
        return;
      }
      added_.push_back(host);
    }
  }

  std::string why_not_;
  std::vector<std::string> added_;
};

}  // namespace counterpart::testing_support
