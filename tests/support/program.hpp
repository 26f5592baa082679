// Runs a program of this project as a user would: arguments in; exit code, stdout and stderr out.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace counterpart::testing_support {

// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

// A running program; killed when this object dies.
class Program {
 public:
  // name: of a program in build/<preset>/bin, or a path.
  Program(const std::string& name, const std::vector<std::string>& arguments);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  void send_signal(int signal) const;
  // Exit code; 128 + signal if it was killed by one; -1 if it still runs after the wait.
  int wait(std::chrono::seconds at_most);
  bool running();

  std::string stdout_text() const;
  std::string stderr_text() const;
  // Waits until stderr holds `text`; false if it does not come in time or the program ends before.
  bool wait_for_stderr(const std::string& text, std::chrono::seconds at_most);

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int exit_code_ = -1;
};

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

// Runs to the end.
Outcome run(const std::string& name, const std::vector<std::string>& arguments,
            std::chrono::seconds at_most = std::chrono::seconds(60));

}  // namespace counterpart::testing_support
