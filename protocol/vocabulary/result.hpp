// Failure is a value: a code for programs, a sentence for people.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace counterpart {

enum class ErrorCode : std::uint16_t {
  invalid_argument = 1,  // the caller asked for something that cannot be
  not_found = 2,         // a file, device, piece or clip that is not there
  io = 3,                // reading or writing failed
  bad_format = 4,        // bytes or text that do not follow their format
  unsupported = 5,       // a feature this build or peer does not have
  version_mismatch = 6,  // no version in common with the peer
  timeout = 7,           // it did not happen in time
  closed = 8,            // the other side is gone
  refused = 9,           // not allowed (token, limits, state)
  not_a_number = 10,     // a computation ended in NaN or infinity
  limit_exceeded = 11,   // larger, more or faster than permitted
  unavailable = 12,      // in use, not ready, or not enough of it
  internal = 13,         // a defect of this program
};

struct [[nodiscard]] Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;  // one sentence: what happened, where, what to do
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(ErrorCode code, std::string message) {
  return tl::make_unexpected(Error{code, std::move(message)});
}

}  // namespace counterpart
