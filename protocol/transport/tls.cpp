#include "protocol/transport/tls.hpp"

#include <cerrno>

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/x509_vfy.h>
#include <sys/socket.h>
#include <sys/stat.h>

namespace counterpart {
namespace {

// --- the socket, as OpenSSL sees it: its own way of writing would end the program when the peer has gone ---

int socket_of(BIO* bio) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(BIO_get_data(bio)));
}

int write_socket(BIO* bio, const char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const ssize_t count = ::send(socket_of(bio), bytes, static_cast<std::size_t>(size), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_write(bio);
  return static_cast<int>(count);
}

int read_socket(BIO* bio, char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const ssize_t count = ::recv(socket_of(bio), bytes, static_cast<std::size_t>(size), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_read(bio);
  return static_cast<int>(count);
}

long control_socket(BIO*, int what, long, void*) {
  return what == BIO_CTRL_FLUSH ? 1 : 0;  // nothing is held back
}

const BIO_METHOD* socket_method() {
  static const BIO_METHOD* const method = [] {
    BIO_METHOD* made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket");
    BIO_meth_set_write(made, write_socket);
    BIO_meth_set_read(made, read_socket);
    BIO_meth_set_ctrl(made, control_socket);
    return made;
  }();
  return method;
}

// --- troubles ---

tl::unexpected<Error> bad_identity(const std::string& file, const std::string& problem) {
  ERR_clear_error();
  return failure(ErrorCode::bad_format, "the TLS file " + file + " " + problem + "; vhp certificate makes such files");
}

Error handshake_error(const SSL* stream) {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  const int what = ERR_GET_LIB(code) == ERR_LIB_SSL ? ERR_GET_REASON(code) : 0;
  if (what == SSL_R_CERTIFICATE_VERIFY_FAILED) {
    return {ErrorCode::refused, std::string("the peer's certificate is not accepted: ") +
                                    X509_verify_cert_error_string(SSL_get_verify_result(stream)) +
                                    "; both sides need files of the same vhp certificate"};
  }
  if (what == SSL_R_WRONG_VERSION_NUMBER) {
    return {ErrorCode::refused, "the peer does not speak TLS 1.3: give both sides a --tls-file, or neither"};
  }
  const char* const reason = ERR_reason_error_string(code);
  return {ErrorCode::refused, std::string("TLS with the peer failed: ") + (reason != nullptr ? reason : "no reason") +
                                  "; both sides need files of the same vhp certificate"};
}

}  // namespace

Result<TlsIdentity> read_tls_identity(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    return failure(ErrorCode::not_found, "the TLS file " + file + " cannot be opened; make it with vhp certificate");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return failure(ErrorCode::refused, "the TLS file " + file + " can be read by others; run: chmod 600 " + file);
  }
  TlsIdentity identity(SSL_CTX_new(TLS_method()));
  SSL_CTX* const context = identity.get();
  if (context == nullptr) return failure(ErrorCode::internal, "OpenSSL gives no context for TLS");
  SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION);
  SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(context, 0);  // the session that is resumed is ours, and every connection shows who it is
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  if (SSL_CTX_use_PrivateKey_file(context, file.c_str(), SSL_FILETYPE_PEM) != 1) {
    return bad_identity(file, "has no private key");
  }
  if (SSL_CTX_use_certificate_chain_file(context, file.c_str()) != 1) {
    return bad_identity(file, "has no certificate that fits its key");
  }
  if (SSL_CTX_check_private_key(context) != 1) return bad_identity(file, "has a certificate of another key");
  if (SSL_CTX_load_verify_file(context, file.c_str()) != 1) return bad_identity(file, "has no authority");
  return identity;
}

TlsStream::TlsStream(SSL_CTX& identity, int socket, End end) : stream_(SSL_new(&identity)) {
  BIO* const bio = BIO_new(socket_method());
  BIO_set_data(bio, reinterpret_cast<void*>(static_cast<std::intptr_t>(socket)));
  BIO_set_init(bio, 1);
  SSL_set_bio(stream_.get(), bio, bio);
  if (end == End::client) {
    SSL_set_connect_state(stream_.get());
  } else {
    SSL_set_accept_state(stream_.get());
  }
}

ssize_t TlsStream::read(std::span<std::uint8_t> into) {
  ERR_clear_error();
  return outcome(SSL_read(stream_.get(), into.data(), static_cast<int>(into.size())));
}

ssize_t TlsStream::write(ByteView bytes) {
  ERR_clear_error();
  return outcome(SSL_write(stream_.get(), bytes.data(), static_cast<int>(bytes.size())));
}

ssize_t TlsStream::outcome(int result) {
  if (result > 0) return result;
  const int system_error = errno;
  switch (SSL_get_error(stream_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      waits_to_write_ = false;
      errno = EAGAIN;
      return -1;
    case SSL_ERROR_WANT_WRITE:
      waits_to_write_ = true;
      errno = EAGAIN;
      return -1;
    case SSL_ERROR_ZERO_RETURN:
      return 0;
    case SSL_ERROR_SYSCALL:
      errno = system_error != 0 ? system_error : ECONNRESET;
      return -1;
    default:
      if (ERR_GET_REASON(ERR_peek_error()) != SSL_R_UNEXPECTED_EOF_WHILE_READING) {
        error_ = handshake_error(stream_.get());
      }
      ERR_clear_error();
      errno = ECONNRESET;
      return -1;
  }
}

}  // namespace counterpart
