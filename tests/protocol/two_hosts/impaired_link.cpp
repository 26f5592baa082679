// A bad line between two network namespaces: IP packets go from a TUN device in one to a TUN device in the other, late,
// lost or out of order, by seed. It stands in for tc netem, which many kernels are built without.
//   impaired_link NAMESPACE NAMESPACE DELAY_MS JITTER_MS LOSS REORDER SEED MBIT_PER_S     ends on SIGTERM
// MBIT_PER_S is what each way carries, behind a queue of 200 ms; 0: no limit.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace {

constexpr std::size_t kMostWaiting = 5'000;
constexpr double kLongestQueue_s = 0.2;

volatile std::sig_atomic_t g_ending = 0;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void give_up(const std::string& what) {
  std::fprintf(stderr, "impaired_link: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(1);
}

// The device belongs to the namespace that the process is in when it is made.
int tun_in(const std::string& name_space) {
  const int space = ::open(("/run/netns/" + name_space).c_str(), O_RDONLY | O_CLOEXEC);
  if (space < 0 || ::setns(space, CLONE_NEWNET) != 0) give_up(name_space);
  ::close(space);
  const int tun = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (tun < 0) give_up("/dev/net/tun");
  ifreq request{};
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  std::strncpy(request.ifr_name, "far0", IFNAMSIZ - 1);
  if (::ioctl(tun, TUNSETIFF, &request) != 0) give_up("TUNSETIFF");
  return tun;
}

struct Packet {
  double due_s = 0;
  std::uint64_t number = 0;
  std::vector<char> bytes;
  bool operator<(const Packet& other) const {
    return due_s != other.due_s ? due_s > other.due_s : number > other.number;
  }
};

struct Line {
  double delay_s = 0, jitter_s = 0, loss = 0, reorder = 0;
  double bytes_per_s = 0;                 // 0: no limit
  std::array<double, 2> free_at_s{0, 0};  // when each way has carried what is in its queue
  std::mt19937_64 random;
  std::uint64_t number = 0, lost = 0, early = 0;

  double chance() { return std::uniform_real_distribution<double>(0, 1)(random); }

  // How long a packet of this size waits for those before it and for itself; empty: the queue is full.
  std::optional<double> queued_s(std::size_t size, std::size_t side) {
    if (bytes_per_s == 0) return 0;
    const double now = now_s(), begins = std::max(now, free_at_s[side]);
    if (begins - now > kLongestQueue_s) return std::nullopt;
    free_at_s[side] = begins + static_cast<double>(size) / bytes_per_s;
    return free_at_s[side] - now;
  }

  void take(std::vector<char> bytes, std::priority_queue<Packet>& waiting, std::size_t side) {
    ++number;
    const bool gone = chance() < loss || waiting.size() >= kMostWaiting;
    const auto in_queue_s = gone ? std::nullopt : queued_s(bytes.size(), side);
    if (!in_queue_s) {
      ++lost;
      return;
    }
    double delay = std::max(0.0, delay_s + jitter_s * (2 * chance() - 1));
    if (chance() < reorder) {
      delay = 0;  // overtakes those before it
      ++early;
    }
    waiting.push({now_s() + *in_queue_s + delay, number, std::move(bytes)});
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 9) return 2;
  std::signal(SIGTERM, [](int) { g_ending = 1; });
  const std::array<int, 2> tun{tun_in(argv[1]), tun_in(argv[2])};
  Line line;
  line.delay_s = std::atof(argv[3]) / 1e3;
  line.jitter_s = std::atof(argv[4]) / 1e3;
  line.loss = std::atof(argv[5]);
  line.reorder = std::atof(argv[6]);
  line.bytes_per_s = std::atof(argv[8]) * 1e6 / 8;
  line.random.seed(std::strtoull(argv[7], nullptr, 10));
  std::fprintf(stderr, "ready\n");
  std::array<std::priority_queue<Packet>, 2> waiting;
  std::array<char, 65536> buffer{};
  while (g_ending == 0) {
    double next_s = now_s() + 0.2;
    for (const auto& queue : waiting) next_s = queue.empty() ? next_s : std::min(next_s, queue.top().due_s);
    const double wait_s = std::max(0.0, next_s - now_s());
    const timespec limit{0, static_cast<long>(wait_s * 1e9)};
    std::array<pollfd, 2> waits{{{tun[0], POLLIN, 0}, {tun[1], POLLIN, 0}}};
    ::ppoll(waits.data(), waits.size(), &limit, nullptr);
    for (std::size_t side = 0; side < 2; ++side) {
      for (ssize_t count = 0; (count = ::read(tun[side], buffer.data(), buffer.size())) > 0;) {
        line.take({buffer.begin(), buffer.begin() + count}, waiting[side], side);
      }
      for (; !waiting[side].empty() && waiting[side].top().due_s <= now_s(); waiting[side].pop()) {
        const auto& bytes = waiting[side].top().bytes;
        if (::write(tun[1 - side], bytes.data(), bytes.size()) < 0) ++line.lost;
      }
    }
  }
  std::fprintf(stderr, "%llu packets, %llu lost, %llu early\n", static_cast<unsigned long long>(line.number),
               static_cast<unsigned long long>(line.lost), static_cast<unsigned long long>(line.early));
  return 0;
}
