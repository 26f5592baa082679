#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "protocol/transport/certificates.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

struct CertificateArguments {
  std::string folder;
  std::vector<std::string> hosts{"tracker", "renderer"};
  int days = 3650;
};

int run_certificate(const CertificateArguments& arguments) {
  const auto files = make_certificates(arguments.folder, arguments.hosts, std::chrono::days(arguments.days));
  if (!files) return fail(files.error());
  for (const std::string& file : *files) std::cout << file << '\n';
  std::cerr << "Bring each file to its host by a safe way, remove it here, and give it to every program there with "
               "--tls-file.\n";
  return kFine;
}

}  // namespace

void add_certificate(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<CertificateArguments>();
  CLI::App* command = app.add_subcommand("certificate", "Makes what each host needs for TLS, one file a host");
  command->add_option("FOLDER", a->folder, "Where to put them; made if it is not there")->required();
  command->add_option("--host", a->hosts, "A name, for NAME.pem; may be given several times")->capture_default_str();
  command->add_option("--days", a->days, "How long they are valid")->check(CLI::Range(1, 36500))->capture_default_str();
  command->callback([a, &exit_code] { exit_code = run_certificate(*a); });
}

}  // namespace counterpart::vhp
