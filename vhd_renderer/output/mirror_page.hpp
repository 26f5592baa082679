// The page of the web mirror, made from mirror.html when the project is built.
#pragma once

#include <string_view>

namespace counterpart {

extern const std::string_view kMirrorPage;

}  // namespace counterpart
