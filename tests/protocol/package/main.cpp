// A program of somebody else: opens a link to itself and sends a command over it.
#include <cstdio>
#include <variant>

#include "protocol/transport/endpoint.hpp"

int main() {
  using namespace counterpart;
  constexpr std::int64_t kSecond = 1'000'000'000;
  LinkOptions options;
  options.role = Role::tracker;
  auto tracker = listen_tcp("127.0.0.1:0", options);
  if (!tracker) return 1;
  options.role = Role::renderer;
  auto renderer = connect_tcp((*tracker)->address(), options, 5 * kSecond);
  if (!renderer) return 1;
  Command command;
  command.id = 7;
  command.action = Say{"hello", "en", ""};
  (*renderer)->broadcast(command);
  for (int i = 0; i < 50; ++i) {
    for (const Inbound& inbound : (*tracker)->receive(kSecond / 10)) {
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr || !std::holds_alternative<Command>(received->message)) continue;
      std::puts("the command came");
      return 0;
    }
  }
  return 1;
}
