// What the subcommands of vhp share.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "protocol/transport/endpoint.hpp"

namespace CLI {
class App;
}

namespace counterpart::vhp {

// Exit codes of every program here.
constexpr int kFine = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

// Options that every subcommand with a link has.
struct LinkArguments {
  std::string address;
  std::string token_file;
  double patience_s = 3;  // how long to wait for the peer
  std::string tls_file;
};

// --token-file and --tls-file.
void add_security(CLI::App& command, LinkArguments& arguments);

// Writes "vhp: ..." to stderr; returns kFailed, or kWrongUsage for what cannot be meant.
int fail(const Error& error);

// Connects and waits for the session.
[[nodiscard]] Result<std::unique_ptr<Endpoint>> open_link(const LinkArguments& arguments, Role role, bool want_video,
                                                          const std::string& record_file = "");

}  // namespace counterpart::vhp
