// Certificates for an installation: an authority that signs one for each host and then forgets its key, so that nobody
// can ever sign another.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Writes FOLDER/NAME.pem for each name (see read_tls_identity), readable by the owner alone; returns the files. Makes
// the folder; refuses to replace a file that is there. Valid from an hour ago, for clocks that differ, until so many
// days from now.
[[nodiscard]] Result<std::vector<std::string>> make_certificates(const std::string& folder,
                                                                 const std::vector<std::string>& names,
                                                                 std::chrono::days valid);

}  // namespace counterpart
