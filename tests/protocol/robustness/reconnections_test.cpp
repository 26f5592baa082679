// Links that are cut or fall silent, many times over.
#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/transport/address.hpp"
#include "protocol/transport/endpoint.hpp"
#include "tests/protocol/robustness/footprint.hpp"
#include "tests/protocol/robustness/scale.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/relay.hpp"

namespace counterpart {
namespace {

using testing_support::options_of;

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kTick = 20'000'000;

template <class T>
bool holds(const std::vector<Inbound>& all) {
  return std::any_of(all.begin(), all.end(), [](const Inbound& inbound) { return std::holds_alternative<T>(inbound); });
}

// Seconds until it came; 30 if it did not.
template <class T>
double seconds_until(Endpoint& endpoint) {
  const auto start = Clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  while (passed() < 30) {
    if (holds<T>(endpoint.receive(kTick))) return passed();
  }
  return 30;
}

struct Linked {
  Linked()
      : tracker(*listen_tcp("127.0.0.1:0", options_of(Role::tracker))),
        relay(parse_address(tracker->address())->port),
        renderer(*connect_tcp(relay.address(), options_of(Role::renderer))) {
    seconds_until<PeerJoined>(*renderer);
    seconds_until<PeerJoined>(*tracker);
  }

  std::unique_ptr<Endpoint> tracker;
  Relay relay;
  std::unique_ptr<Endpoint> renderer;
};

void tell(const char* what, std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  std::cout << "  " << what << ": median " << seconds[seconds.size() / 2] << " s, longest " << seconds.back()
            << " s, of " << seconds.size() << '\n';
}

TEST(Reconnections, LeaveNothingBehind) {
  Linked link;
  const int times = scaled(60, 1'000);
  Footprint before;
  std::vector<double> away;
  for (int i = 0; i < times; ++i) {
    if (i == times / 3) before = footprint();
    link.relay.cut();
    away.push_back(seconds_until<PeerJoined>(*link.renderer));
    ASSERT_LT(away.back(), 30);
    static_cast<void>(link.tracker->receive(0));
  }
  tell("back after a cut", away);
  const Footprint after = footprint();
  EXPECT_LE(after.descriptors, before.descriptors + 4) << "the video lane may be open now and closed then";
  if (!memory_can_be_measured()) return;
  EXPECT_LE(after.resident_kib, before.resident_kib + 4 * 1024);
}

TEST(Reconnections, ASilentLinkIsNoticedOnBothSidesAndComesBack) {
  Linked link;
  std::vector<double> noticed, back;
  const int times = scaled(1, 10);
  for (int i = 0; i < times; ++i) {
    link.relay.silence(true);
    noticed.push_back(seconds_until<PeerLeft>(*link.renderer));
    ASSERT_LT(noticed.back(), 30);
    EXPECT_LT(seconds_until<PeerLeft>(*link.tracker), 30);
    for (int wait = 0; wait < 7 * i; ++wait)
      static_cast<void>(link.renderer->receive(kTick));  // any phase of the waits
    link.relay.silence(false);
    back.push_back(seconds_until<PeerJoined>(*link.renderer));
    ASSERT_LT(back.back(), 30);
    seconds_until<PeerJoined>(*link.tracker);
  }
  tell("silence noticed", noticed);
  tell("game goes on after the link is back", back);
}

}  // namespace
}  // namespace counterpart
