// Proving knowledge of a shared token without sending it: docs/protocol.md, section 5.
#pragma once

#include <string>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// One line of at least 16 bytes, in a file that only its owner can read.
[[nodiscard]] Result<std::string> read_token(const std::string& file);

enum class Prover { client, server };

Bytes32 prove(const std::string& token, Prover prover, const Bytes32& server_nonce, const Bytes32& client_nonce,
              ByteView hello_body);

// In a time that does not depend on where they differ.
bool same(const Bytes32& a, const Bytes32& b);

Bytes32 random_bytes();
std::uint64_t random_session();  // never 0

}  // namespace counterpart
