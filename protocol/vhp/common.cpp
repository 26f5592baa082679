#include "protocol/vhp/common.hpp"

#include <iostream>

namespace counterpart::vhp {

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
