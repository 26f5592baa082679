#include "protocol/vhp/common.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

namespace counterpart::vhp {

int fail(const Error& error) {
  std::cerr << "vhp: " << error.message << '\n';
  return error.code == ErrorCode::invalid_argument ? kWrongUsage : kFailed;
}

void add_security(CLI::App& command, LinkArguments& arguments) {
  command.add_option("--token-file", arguments.token_file, "The shared token, for other hosts");
  command.add_option("--tls-file", arguments.tls_file, "TLS 1.3, with this file of vhp certificate");
}

Result<std::unique_ptr<Endpoint>> open_link(const LinkArguments& arguments, Role role, bool want_video,
                                            const std::string& record_file) {
  LinkOptions options;
  options.role = role;
  options.software = "vhp " COUNTERPART_VERSION;
  options.token_file = arguments.token_file;
  options.tls_file = arguments.tls_file;
  options.want_video = want_video;
  options.takes_h264 = true;                  // nobody looks at the pictures here
  options.want_debug = !record_file.empty();  // a capture holds everything
  options.record_file = record_file;
  return connect_tcp(arguments.address, options, static_cast<std::int64_t>(arguments.patience_s * 1e9));
}

}  // namespace counterpart::vhp
