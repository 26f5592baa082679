// TLS 1.3 on a connected socket, and what one host needs for it (docs/adr/0022). Both sides show a certificate; each
// must be signed by the authority that the other one knows.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include <openssl/ssl.h>
#include <sys/types.h>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct TlsDeleter {
  void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
  void operator()(SSL* stream) const { SSL_free(stream); }
};

// Who this host is, and whom it believes.
using TlsIdentity = std::unique_ptr<SSL_CTX, TlsDeleter>;

// file: PEM with this host's private key, its certificate, and the authority's certificate, in this order, readable by
// its owner alone: what make_certificates writes.
[[nodiscard]] Result<TlsIdentity> read_tls_identity(const std::string& file);

// Reads and writes like a socket that never blocks. Opening it is part of reading and writing.
class TlsStream {
 public:
  enum class End { client, server };

  // `socket` stays the caller's.
  TlsStream(SSL_CTX& identity, int socket, End end);

  // Like recv and send: a count, 0 at the end, -1 with EAGAIN when the socket must be ready first, -1 with another
  // errno when it is broken. What could not be written must be offered again.
  ssize_t read(std::span<std::uint8_t> into);
  ssize_t write(ByteView bytes);

  // After EAGAIN: it is the socket's readiness to write that is waited for, else to read.
  bool waits_to_write() const { return waits_to_write_; }

  // Bytes were taken from the socket that read() has not given out.
  bool has_pending() const { return SSL_pending(stream_.get()) > 0; }

  // Why it is broken, if TLS is the reason.
  const std::optional<Error>& error() const { return error_; }

 private:
  ssize_t outcome(int result);

  std::unique_ptr<SSL, TlsDeleter> stream_;
  bool waits_to_write_ = false;
  std::optional<Error> error_;
};

}  // namespace counterpart
