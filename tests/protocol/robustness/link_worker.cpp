// One end of a link as a program that may be killed at any moment: what it has done is in its journal before it says
// so.
//   link_worker tracker LISTEN JOURNAL COUNT     has commands 1..COUNT carried out; a line "ID" for each answer
//   link_worker renderer ADDRESS JOURNAL         carries them out; a line "ID" each, "twice ID" if the link gave one
//   twice link_worker recorder CAPTURE                 records command 1, 2, ... until it is killed
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "protocol/capture/recorder.hpp"
#include "protocol/codec/codec.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/monotonic_clock.hpp"

namespace {

using namespace counterpart;

constexpr std::uint64_t kOnTheWay = 64;
constexpr std::int64_t kPatience = 100'000'000;

// Lines that a kill -9 does not take back. Each is one write, so there are no halves.
class Journal {
 public:
  explicit Journal(const std::string& path) : file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600)) {
    std::ifstream before(path);
    for (std::string line; std::getline(before, line);) done_.insert(std::strtoull(line.c_str(), nullptr, 10));
  }

  bool has(std::uint64_t id) const { return done_.count(id) > 0; }

  void add(std::uint64_t id) {
    write_line(std::to_string(id));
    done_.insert(id);
  }

  void write_line(const std::string& line) const {
    const std::string text = line + "\n";
    if (::write(file_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) std::exit(1);
  }

 private:
  int file_;
  std::set<std::uint64_t> done_;
};

LinkOptions worker_options(Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "link_worker";
  return options;
}

std::unique_ptr<Endpoint> take(Result<std::unique_ptr<Endpoint>> link) {
  if (link) return std::move(*link);
  std::fprintf(stderr, "%s\n", link.error().message.c_str());
  std::exit(1);
}

// A renderer it has not seen gets every command again that has no answer yet.
int ask(Endpoint& link, Journal& journal, std::uint64_t count) {
  std::set<std::uint64_t> open;
  std::uint64_t next = 1;
  PeerId renderer = 0;
  const auto send = [&](std::uint64_t id) {
    Command command;
    command.id = id;
    command.action = Say{"hello", "en", ""};
    link.send(renderer, command);
  };
  while (next <= count || !open.empty()) {
    for (const Inbound& inbound : link.receive(kPatience)) {
      if (const auto* joined = std::get_if<PeerJoined>(&inbound)) {
        const bool fresh = joined->peer != renderer;
        renderer = joined->peer;
        if (fresh) {
          for (const std::uint64_t id : open) send(id);
        }
      }
      const auto* received = std::get_if<Received>(&inbound);
      const auto* feedback = received == nullptr ? nullptr : std::get_if<Feedback>(&received->message);
      if (feedback == nullptr || open.erase(feedback->command_id) == 0) continue;
      journal.add(feedback->command_id);
    }
    for (; renderer != 0 && next <= count && open.size() < kOnTheWay; ++next) {
      if (journal.has(next)) continue;
      open.insert(next);
      send(next);
    }
  }
  return 0;
}

int carry_out(Endpoint& link, Journal& journal) {
  std::map<PeerId, std::set<std::uint64_t>> given;
  for (;;) {
    for (const Inbound& inbound : link.receive(kPatience)) {
      const auto* received = std::get_if<Received>(&inbound);
      const auto* command = received == nullptr ? nullptr : std::get_if<Command>(&received->message);
      if (command == nullptr) continue;
      if (!given[received->peer].insert(command->id).second) journal.write_line("twice " + std::to_string(command->id));
      if (!journal.has(command->id)) journal.add(command->id);
      Feedback feedback;
      feedback.command_id = command->id;
      feedback.state = FeedbackState::finished;
      link.send(received->peer, feedback);
    }
  }
}

int record(const std::string& path) {
  auto recorder = Recorder::open(path, Role::tracker, "link_worker");
  if (!recorder) return 1;
  std::fprintf(stderr, "recording\n");
  for (std::uint64_t id = 1;; ++id) {
    Command command;
    command.id = id;
    command.action = Say{"hello", "en", ""};
    const Bytes body = *encode(command);
    Header header;
    header.type = static_cast<std::uint16_t>(MessageType::command);
    header.seq = id;
    (*recorder)->saw(false, false, 1, seal(header, body), body, monotonic_ns());
    ::usleep(200);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string role = argc > 3 ? argv[1] : "";
  if (role == "tracker" && argc == 5) {
    Journal journal(argv[3]);
    return ask(*take(listen_tcp(argv[2], worker_options(Role::tracker))), journal, std::strtoull(argv[4], nullptr, 10));
  }
  if (role == "renderer" && argc == 4) {
    Journal journal(argv[3]);
    return carry_out(*take(connect_tcp(argv[2], worker_options(Role::renderer))), journal);
  }
  if (argc == 3 && std::string(argv[1]) == "recorder") return record(argv[2]);
  std::fprintf(stderr,
               "usage: link_worker tracker LISTEN JOURNAL COUNT | renderer ADDRESS JOURNAL | recorder CAPTURE\n");
  return 2;
}
