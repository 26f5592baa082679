// Our link against the plainest thing that Boost.Asio can do: length-prefixed blocks, no checksum, no session, one
// thread. Two processes over loopback, each on a core of its own: where the system moves them about, a ping-pong takes
// one time on one core and another on two. Interleaved rounds; medians of the rounds, and of the ratios within a round.
//   link_bench [ROUNDS] [ping_pong|small|frames]
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio.hpp>
#include <sched.h>
#include <unistd.h>

#include "protocol/daemon/picture_memory.hpp"
#include "protocol/transport/address.hpp"
#include "protocol/transport/certificates.hpp"
#include "protocol/transport/endpoint.hpp"

namespace {

using namespace counterpart;
namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::uint32_t kEcho = 1, kData = 2, kEnd = 3;

// The child and the parent get different cores if there are two.
void stay_on_core(unsigned core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core % std::max(1U, std::thread::hardware_concurrency()), &cores);
  static_cast<void>(sched_setaffinity(0, sizeof cores, &cores));
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Block {
  std::uint32_t size = 0;  // of what follows
  std::uint32_t kind = 0;
};

// --- plain Asio ---

void serve_plain(tcp::acceptor& acceptor) {
  for (;;) {
    tcp::socket socket = acceptor.accept();
    socket.set_option(tcp::no_delay(true));
    std::vector<char> buffer(4U << 20);
    std::size_t begin = 0, end = 0;
    boost::system::error_code error;
    const auto need = [&](std::size_t count) {
      while (end - begin < count && !error) {
        if (begin > 0) std::memmove(buffer.data(), buffer.data() + begin, end - begin);
        end -= std::exchange(begin, 0);
        end += socket.read_some(asio::buffer(buffer.data() + end, buffer.size() - end), error);
      }
    };
    while (!error) {
      need(sizeof(Block));
      if (error) break;
      Block block;
      std::memcpy(&block, buffer.data() + begin, sizeof block);
      need(sizeof block + block.size);
      if (error) break;
      if (block.kind != kData) {
        asio::write(socket, asio::buffer(buffer.data() + begin, sizeof block + block.size), error);
      }
      begin += sizeof block + block.size;
      if (begin == end) begin = end = 0;
    }
  }
}

class Plain {
 public:
  explicit Plain(std::uint16_t port) : socket_(io_) {
    socket_.connect({asio::ip::address_v4::loopback(), port});
    socket_.set_option(tcp::no_delay(true));
  }

  // total: bytes of a message with its header.
  double ping_pong(int count, std::size_t total) {
    std::vector<double> times;
    std::vector<char> out = block(kEcho, total), in(total);
    for (int i = 0; i < count; ++i) {
      const double start = now();
      asio::write(socket_, asio::buffer(out));
      asio::read(socket_, asio::buffer(in));
      times.push_back(now() - start);
    }
    std::nth_element(times.begin(), times.begin() + count / 2, times.end());
    return times[static_cast<std::size_t>(count / 2)];
  }

  double one_way(int count, std::size_t total) {
    const std::vector<char> out = block(kData, total);
    const std::vector<char> last = block(kEnd, sizeof(Block));
    const double start = now();
    for (int i = 0; i < count; ++i) asio::write(socket_, asio::buffer(out));
    asio::write(socket_, asio::buffer(last));
    std::vector<char> in(last.size());
    asio::read(socket_, asio::buffer(in));
    return count / (now() - start);
  }

 private:
  static std::vector<char> block(std::uint32_t kind, std::size_t total) {
    std::vector<char> bytes(total, 'x');
    const Block head{static_cast<std::uint32_t>(total - sizeof(Block)), kind};
    std::memcpy(bytes.data(), &head, sizeof head);
    return bytes;
  }

  asio::io_context io_;
  tcp::socket socket_;
};

// --- our link: in real time for answers, in lockstep for streams, so that nothing is dropped ---

struct Way {
  bool lockstep = false;
  std::string record_file, tls_file;
};

LinkOptions options_of(Role role, const Way& way) {
  LinkOptions options;
  options.role = role;
  options.software = "bench";
  options.lockstep = way.lockstep;
  options.record_file = way.record_file;
  options.tls_file = way.tls_file;
  return options;
}

// Answers a pose of object 1 with itself, and FRAME_DONE with FRAME_DONE.
void serve_link(Endpoint& endpoint) {
  for (;;) {
    for (const Inbound& inbound : endpoint.receive(kSecond)) {
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      const auto* pose = std::get_if<PoseEstimate>(&received->message);
      if (pose != nullptr && pose->object_id == 1) endpoint.send(received->peer, *pose);
      if (std::holds_alternative<FrameDone>(received->message)) endpoint.send(received->peer, received->message);
    }
  }
}

class Ours {
 public:
  Ours(std::uint16_t port, const Way& way) {
    auto link = connect_tcp("127.0.0.1:" + std::to_string(port), options_of(Role::renderer, way), 5 * kSecond);
    if (!link) {
      std::fprintf(stderr, "%s\n", link.error().message.c_str());
      std::exit(1);
    }
    link_ = std::move(*link);
    wait<PeerJoined>();
  }

  double ping_pong(int count) {
    std::vector<double> times;
    PoseEstimate pose;
    pose.object_id = 1;
    for (int i = 0; i < count; ++i) {
      pose.stamp.frame_id = static_cast<FrameId>(i);
      const double start = now();
      link_->send(peer_, pose);
      while (!take<PoseEstimate>()) {
      }
      times.push_back(now() - start);
    }
    std::nth_element(times.begin(), times.begin() + count / 2, times.end());
    return times[static_cast<std::size_t>(count / 2)];
  }

  double one_way(int count, const Message& message, std::uint32_t window) {
    const double start = now();
    for (int i = 0; i < count; ++i) {
      link_->send(peer_, message);
      if (static_cast<std::uint32_t>(i) % (window / 2) != 0) continue;
      while (link_->stats().front().unacknowledged > window) static_cast<void>(link_->receive(1'000'000));
    }
    while (link_->stats().front().unacknowledged > 0) static_cast<void>(link_->receive(200'000));
    return count / (now() - start);
  }

 private:
  template <class T>
  bool take() {
    for (const Inbound& inbound : link_->receive(kSecond)) {
      const auto* received = std::get_if<Received>(&inbound);
      if (received != nullptr && std::holds_alternative<T>(received->message)) return true;
    }
    return false;
  }

  template <class T>
  void wait() {
    for (;;) {
      for (const Inbound& inbound : link_->receive(kSecond)) {
        if (const auto* joined = std::get_if<T>(&inbound)) {
          peer_ = joined->peer;
          return;
        }
      }
    }
  }

  std::unique_ptr<Endpoint> link_;
  PeerId peer_ = 0;
};

// The rows of one side; every round adds a value to each.
struct Rows {
  std::vector<double> ping_pong_us, small_per_s, frames_per_s;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void print(const char* name, const Rows& rows) {
  std::printf("  \"%s\": {\"ping_pong_p50_us\": %.1f, \"small_per_s\": %.0f, \"raw_frames_per_s\": %.0f},\n", name,
              median(rows.ping_pong_us), median(rows.small_per_s), median(rows.frames_per_s));
}

// Of what was measured one after the other, so that both felt the same load of the machine.
double median_ratio(const std::vector<double>& ours, const std::vector<double>& plain) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.size(); ++i) ratios.push_back(ours[i] / plain[i]);
  return median(ratios);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const std::string only = argc > 2 ? argv[2] : "";
  keep_picture_memory();  // as the daemons do; plain Asio reads into memory of its own, made once
  const std::string certificates = (std::filesystem::temp_directory_path() / "link_bench_tls").string();
  std::filesystem::remove_all(certificates);
  if (!make_certificates(certificates, {"tracker", "renderer"}, std::chrono::days(1))) return 1;
  int ports[2];
  if (pipe(ports) != 0) return 1;
  const pid_t child = fork();
  stay_on_core(child == 0 ? 1 : 0);
  if (child == 0) {
    asio::io_context io;
    tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
    auto endpoint = listen_tcp("127.0.0.1:0", options_of(Role::tracker, {true}));
    auto secure = listen_tcp("127.0.0.1:0", options_of(Role::tracker, {true, "", certificates + "/tracker.pem"}));
    if (!endpoint || !secure) return 1;
    const std::uint16_t all[3] = {acceptor.local_endpoint().port(), parse_address((*endpoint)->address())->port,
                                  parse_address((*secure)->address())->port};
    if (write(ports[1], all, sizeof all) != sizeof all) return 1;
    std::thread plain([&] { serve_plain(acceptor); });
    std::thread tls([&] { serve_link(**secure); });
    serve_link(**endpoint);
  }
  std::uint16_t all[3] = {0, 0, 0};
  if (read(ports[0], all, sizeof all) != sizeof all) return 1;
  VideoFrame frame;
  frame.width = 720;
  frame.height = 576;
  frame.stride = 2160;
  frame.bytes.assign(2160 * 576, 7);
  PoseEstimate pose;
  const std::string tls_file = certificates + "/renderer.pem";
  Rows plain, ours, recorded, secure;
  {
    Plain a(all[0]);
    Ours b(all[1], {});
    Ours c(all[1], {false, "/tmp/link_bench.mcap"});
    Ours d(all[1], {true});
    Ours e(all[2], {false, "", tls_file});
    Ours f(all[2], {true, "", tls_file});
    for (int round = 0; round < rounds; ++round) {
      if (only.empty() || only == "ping_pong") {
        plain.ping_pong_us.push_back(1e6 * a.ping_pong(5000, 228));
        ours.ping_pong_us.push_back(1e6 * b.ping_pong(5000));
        recorded.ping_pong_us.push_back(1e6 * c.ping_pong(5000));
        secure.ping_pong_us.push_back(1e6 * e.ping_pong(5000));
      }
      if (only.empty() || only == "small") {
        plain.small_per_s.push_back(a.one_way(100'000, 228));
        ours.small_per_s.push_back(d.one_way(100'000, pose, 16'000));
        secure.small_per_s.push_back(f.one_way(100'000, pose, 16'000));
      }
      if (only.empty() || only == "frames") {
        plain.frames_per_s.push_back(a.one_way(200, 48 + 32 + frame.bytes.size()));
        ours.frames_per_s.push_back(d.one_way(200, frame, 8));
        secure.frames_per_s.push_back(f.one_way(200, frame, 8));
      }
    }
  }
  kill(child, SIGKILL);
  std::printf("{\n");
  print("plain_asio", plain);
  print("link", ours);
  print("link_tls", secure);
  std::printf("  \"ratios\": {\"ping_pong\": %.2f, \"small\": %.2f, \"frames\": %.2f, \"recording_adds\": %.3f}\n}\n",
              median_ratio(ours.ping_pong_us, plain.ping_pong_us), median_ratio(ours.small_per_s, plain.small_per_s),
              median_ratio(ours.frames_per_s, plain.frames_per_s),
              median_ratio(recorded.ping_pong_us, ours.ping_pong_us) - 1);
  return 0;
}
