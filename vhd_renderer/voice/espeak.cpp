#include "vhd_renderer/voice/espeak.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vhd_renderer/voice/wav.hpp"

extern char** environ;

namespace counterpart {
namespace {

constexpr std::size_t longest_text = 4000;
constexpr std::size_t most_bytes = 32U << 20U;  // ten minutes of speech
constexpr std::chrono::seconds patience{5};
constexpr std::chrono::milliseconds glance{50};  // how often it is seen whether the sound is still wanted
constexpr std::size_t longest_queue = 32;        // sentences; what is beyond it is not spoken
constexpr std::size_t remembered = 200;          // sentences

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

// "en", "pt-br", "en-us+f2"; nothing that could be an option or a path.
bool plain_name(const std::string& name) {
  return name.size() <= 24 && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
         });
}

tl::unexpected<Error> trouble(const std::string& what) {
  return failure(ErrorCode::unavailable, "espeak-ng cannot speak: " + what);
}

// All that comes until the end; empty if it takes too long, gets too much, or is not wanted any more.
std::string read_all(int fd, const std::stop_token& stop) {
  const auto until = std::chrono::steady_clock::now() + patience;
  std::string bytes;
  std::array<char, 65536> chunk;
  for (;;) {
    if (stop.stop_requested() || std::chrono::steady_clock::now() >= until) return {};
    pollfd one{fd, POLLIN, 0};
    if (poll(&one, 1, static_cast<int>(glance.count())) == 0) continue;
    const ssize_t got = read(fd, chunk.data(), chunk.size());
    if (got == 0) return bytes;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 || bytes.size() + static_cast<std::size_t>(got) > most_bytes) return {};
    bytes.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

Result<Sound> speak(const std::string& text, const std::string& language, const std::string& variant,
                    const std::string& program, const std::stop_token& stop) {
  if (text.size() > longest_text) return failure(ErrorCode::limit_exceeded, "a text of over 4000 bytes is not spoken");
  if (language.empty() || !plain_name(language) || !plain_name(variant)) {
    return failure(ErrorCode::invalid_argument,
                   "\"" + language + "\" is no language for speech; give \"en\", \"nl\" ...");
  }
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return trouble(std::strerror(errno));
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to.get(), STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  std::array<std::string, 6> words{program,    "-v", variant.empty() ? language : language + "+" + variant,
                                   "--stdout", "--", text};
  std::array<char*, 7> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  pid_t child = 0;
  const int spawned = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (spawned != 0) return trouble(std::string(std::strerror(spawned)) + "; install the Debian package espeak-ng");
  to.close();
  const std::string bytes = read_all(from.get(), stop);
  if (bytes.empty()) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (bytes.empty() || status != 0) return trouble("it gave no sound for the language \"" + language + "\"");
  return decode_wav(bytes);
}

namespace {

// One voice and what it has said.
class Memory {
 public:
  Memory(std::string variant, std::string program) : variant_(std::move(variant)), program_(std::move(program)) {}

  std::shared_ptr<const Sound> say(const std::string& text, const std::string& language,
                                   const std::stop_token& stop = {}) {
    const std::pair key(language, text);
    if (const auto found = said_.find(key); found != said_.end()) return found->second;
    std::shared_ptr<const Sound> sound;
    if (auto spoken = speak(text, language, variant_, program_, stop); spoken) {
      sound = std::make_shared<Sound>(std::move(*spoken));
    } else if (!stop.stop_requested() && !std::exchange(warned_, true)) {
      spdlog::warn("{}; what is said is shown as a subtitle only", spoken.error().message);
    }
    if (said_.size() >= remembered) said_.clear();
    said_.emplace(key, sound);
    return sound;
  }

 private:
  std::string variant_;
  std::string program_;
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const Sound>> said_;
  bool warned_ = false;
};

// Speaks one sentence after the other while others go on with their work.
class VoiceThread {
 public:
  explicit VoiceThread(Memory memory) : memory_(std::move(memory)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  SoundToCome say(const std::string& text, const std::string& language) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= longest_queue) return ready_sound(nullptr);
    waiting_.push_back({text, language, {}});
    arrived_.notify_one();
    return waiting_.back().promise.get_future().share();
  }

 private:
  struct Sentence {
    std::string text;
    std::string language;
    std::promise<std::shared_ptr<const Sound>> promise;
  };

  void run(const std::stop_token& stop) {
    for (;;) {
      std::unique_lock lock(mutex_);
      if (!arrived_.wait(lock, stop, [this] { return !waiting_.empty(); })) return;
      Sentence next = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      next.promise.set_value(memory_.say(next.text, next.language, stop));
    }
  }

  Memory memory_;  // the thread's
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<Sentence> waiting_;
  std::jthread thread_;  // ends before what it works with
};

}  // namespace

Speaker espeak_speaker(const std::string& variant, Speaking speaking, const std::string& program) {
  Memory memory(variant, program);
  if (speaking == Speaking::in_the_background) {
    return [thread = std::make_shared<VoiceThread>(std::move(memory))](
               const std::string& text, const std::string& language) { return thread->say(text, language); };
  }
  return [memory = std::make_shared<Memory>(std::move(memory))](const std::string& text, const std::string& language) {
    return ready_sound(memory->say(text, language));
  };
}

}  // namespace counterpart
