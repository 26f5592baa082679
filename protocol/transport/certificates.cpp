#include "protocol/transport/certificates.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>

#include <fcntl.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include "protocol/session/token.hpp"

namespace counterpart {
namespace {

constexpr long kClocksDiffer_s = 3600;
constexpr int kSerialBytes = 16;

struct Deleter {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(BIO* bio) const { BIO_free(bio); }
};
using Key = std::unique_ptr<EVP_PKEY, Deleter>;
using Certificate = std::unique_ptr<X509, Deleter>;

struct Signer {
  X509* certificate;
  EVP_PKEY* key;
};

bool add_extension(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value);
  const bool added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  return added;
}

bool set_serial(X509* certificate) {
  unsigned char bytes[kSerialBytes];
  if (RAND_bytes(bytes, kSerialBytes) != 1) return false;
  bytes[0] &= 0x7F;  // positive
  BIGNUM* const number = BN_bin2bn(bytes, kSerialBytes, nullptr);
  const bool set = BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate)) != nullptr;
  BN_free(number);
  return set;
}

// Null signer: signs itself, and may sign others.
Certificate certify(EVP_PKEY* key, const std::string& name, std::chrono::days valid, const Signer* signer) {
  Certificate certificate(X509_new());
  X509* const x = certificate.get();
  X509* const issuer = signer != nullptr ? signer->certificate : x;
  const auto* const text = reinterpret_cast<const unsigned char*>(name.c_str());
  bool good = X509_set_version(x, X509_VERSION_3) == 1 && set_serial(x) && X509_set_pubkey(x, key) == 1;
  good = good && X509_gmtime_adj(X509_getm_notBefore(x), -kClocksDiffer_s) != nullptr;
  good = good && X509_time_adj_ex(X509_getm_notAfter(x), static_cast<int>(valid.count()), 0, nullptr) != nullptr;
  good = good && X509_NAME_add_entry_by_txt(X509_get_subject_name(x), "CN", MBSTRING_UTF8, text, -1, -1, 0) == 1;
  good = good && X509_set_issuer_name(x, X509_get_subject_name(issuer)) == 1;
  if (signer == nullptr) {
    good = good && add_extension(x, issuer, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
    good = good && add_extension(x, issuer, NID_key_usage, "critical,keyCertSign");
  } else {
    good = good && add_extension(x, issuer, NID_basic_constraints, "critical,CA:FALSE");
    good = good && add_extension(x, issuer, NID_key_usage, "critical,digitalSignature");
    good = good && add_extension(x, issuer, NID_ext_key_usage, "serverAuth,clientAuth");
  }
  good = good && X509_sign(x, signer != nullptr ? signer->key : key, EVP_sha256()) != 0;
  return good ? std::move(certificate) : nullptr;
}

std::string as_pem(EVP_PKEY* key, X509* certificate, X509* authority) {
  const std::unique_ptr<BIO, Deleter> memory(BIO_new(BIO_s_mem()));
  PEM_write_bio_PrivateKey(memory.get(), key, nullptr, nullptr, 0, nullptr, nullptr);
  PEM_write_bio_X509(memory.get(), certificate);
  PEM_write_bio_X509(memory.get(), authority);
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

Result<void> write_secret(const std::string& file, const std::string& text) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0 && errno == EEXIST) {
    return failure(ErrorCode::invalid_argument, file + " is there already; remove it, or choose another folder");
  }
  if (descriptor < 0) return failure(ErrorCode::io, "cannot write " + file + ": " + std::strerror(errno));
  const ssize_t written = ::write(descriptor, text.data(), text.size());
  if (::close(descriptor) == 0 && written == static_cast<ssize_t>(text.size())) return {};
  return failure(ErrorCode::io, "cannot write " + file + ": is the disk full?");
}

bool is_plain(const std::string& name) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  return !name.empty() && name.size() <= 60 && std::all_of(name.begin(), name.end(), plain);
}

}  // namespace

Result<std::vector<std::string>> make_certificates(const std::string& folder, const std::vector<std::string>& names,
                                                   std::chrono::days valid) {
  for (const std::string& name : names) {
    if (is_plain(name)) continue;
    return failure(ErrorCode::invalid_argument, "'" + name + "' is no name of a host: letters, digits, - and _ only");
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(ErrorCode::io, "cannot make the folder " + folder + ": " + error.message());
  const Key authority_key(EVP_EC_gen("P-256"));
  const std::string authority_name = "Counterpart authority " + std::to_string(random_session());  // no two alike
  const Certificate authority = certify(authority_key.get(), authority_name, valid, nullptr);
  if (!authority) return failure(ErrorCode::internal, "OpenSSL could not make a certificate");
  const Signer signer{authority.get(), authority_key.get()};
  std::vector<std::string> files;
  for (const std::string& name : names) {
    const Key key(EVP_EC_gen("P-256"));
    const Certificate certificate = certify(key.get(), name, valid, &signer);
    if (!certificate) return failure(ErrorCode::internal, "OpenSSL could not make a certificate");
    files.push_back((std::filesystem::path(folder) / (name + ".pem")).string());
    auto written = write_secret(files.back(), as_pem(key.get(), certificate.get(), authority.get()));
    if (!written) return tl::make_unexpected(written.error());
  }
  return files;
}

}  // namespace counterpart
