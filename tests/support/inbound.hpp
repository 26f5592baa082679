// What tests read from an endpoint.
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "protocol/transport/endpoint.hpp"

namespace counterpart::testing_support {

// Collects what comes until the condition holds or ten seconds have passed.
inline std::vector<Inbound> collect(Endpoint& endpoint,
                                    const std::function<bool(const std::vector<Inbound>&)>& enough) {
  std::vector<Inbound> all;
  for (int i = 0; i < 100 && !enough(all); ++i) {
    for (Inbound& inbound : endpoint.receive(100'000'000)) all.push_back(std::move(inbound));
  }
  return all;
}

template <class T>
std::vector<T> messages(const std::vector<Inbound>& all) {
  std::vector<T> found;
  for (const Inbound& inbound : all) {
    const auto* received = std::get_if<Received>(&inbound);
    if (received == nullptr) continue;
    if (const auto* message = std::get_if<T>(&received->message)) found.push_back(*message);
  }
  return found;
}

template <class T>
const T* first(const std::vector<Inbound>& all) {
  for (const Inbound& inbound : all) {
    if (const auto* found = std::get_if<T>(&inbound)) return found;
  }
  return nullptr;
}

inline PeerId joined(Endpoint& endpoint) {
  const auto all = collect(endpoint, [](const auto& a) { return first<PeerJoined>(a) != nullptr; });
  const auto* peer = first<PeerJoined>(all);
  return peer == nullptr ? 0 : peer->peer;
}

}  // namespace counterpart::testing_support
