#include "protocol/vhp/common.hpp"

#include <csignal>
#include <iostream>

namespace counterpart::vhp {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;

}  // namespace

void catch_interrupts() {
  const auto handler = [](int) { g_interrupted = 1; };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return g_interrupted != 0;
}

int fail(const Error& error) {
  std::cerr << "vhp: " << error.message << '\n';
  return error.code == ErrorCode::invalid_argument ? kWrongUsage : kFailed;
}

Result<std::unique_ptr<Endpoint>> open_link(const LinkArguments& arguments, Role role, bool want_video,
                                            const std::string& record_file) {
  LinkOptions options;
  options.role = role;
  options.software = "vhp " COUNTERPART_VERSION;
  options.token_file = arguments.token_file;
  options.want_video = want_video;
  options.record_file = record_file;
  return connect_tcp(arguments.address, options, static_cast<std::int64_t>(arguments.patience_s * 1e9));
}

}  // namespace counterpart::vhp
