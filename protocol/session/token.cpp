#include "protocol/session/token.hpp"

#include <fstream>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>

namespace counterpart {

Result<std::string> read_token(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    return failure(ErrorCode::not_found, "the token file " + file +
                                             " cannot be opened; make one with: (umask 077; "
                                             "openssl rand -hex 32 > " +
                                             file + ")");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return failure(ErrorCode::refused, "the token file " + file + " can be read by others; run: chmod 600 " + file);
  }
  std::ifstream in(file);
  std::string token;
  std::getline(in, token);
  while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) token.pop_back();
  if (!in && token.empty()) return failure(ErrorCode::io, "the token file " + file + " cannot be read");
  if (token.size() < 16) {
    return failure(ErrorCode::bad_format, "the token in " + file + " is shorter than 16 bytes");
  }
  return token;
}

Bytes32 prove(const std::string& token, Prover prover, const Bytes32& server_nonce, const Bytes32& client_nonce,
              ByteView hello_body) {
  const std::string label = prover == Prover::client ? "counterpart 1 client" : "counterpart 1 server";
  Bytes text(label.begin(), label.end());
  text.insert(text.end(), server_nonce.begin(), server_nonce.end());
  text.insert(text.end(), client_nonce.begin(), client_nonce.end());
  text.insert(text.end(), hello_body.begin(), hello_body.end());
  Bytes32 mac{};
  unsigned size = static_cast<unsigned>(mac.size());
  HMAC(EVP_sha256(), token.data(), static_cast<int>(token.size()), text.data(), text.size(), mac.data(), &size);
  return mac;
}

bool same(const Bytes32& a, const Bytes32& b) {
  return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Bytes32 random_bytes() {
  Bytes32 bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) std::abort();  // no entropy: nothing is safe
  return bytes;
}

std::uint64_t random_session() {
  const Bytes32 bytes = random_bytes();
  const auto session = load<std::uint64_t>(bytes.data());
  return session == 0 ? 1 : session;
}

}  // namespace counterpart
