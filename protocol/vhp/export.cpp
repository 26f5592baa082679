#include "protocol/capture/export.hpp"

#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

struct ExportArguments {
  std::string format, file, out = "-";
};

int run_export(const ExportArguments& arguments) {
  auto reader = SessionReader::open(arguments.file);
  if (!reader) return fail(reader.error());
  std::ofstream file;
  if (arguments.out != "-") {
    file.open(arguments.out);
    if (!file) return fail({ErrorCode::io, arguments.out + " cannot be written"});
  }
  std::ostream& out = arguments.out == "-" ? std::cout : file;
  std::uint64_t count = 0;
  if (arguments.format == "csv") count = export_csv(**reader, out);
  if (arguments.format == "pdn") count = export_pdn(**reader, out);
  if (arguments.format == "opentrackio") count = export_opentrackio(**reader, out);
  out.flush();
  if (!out) return fail({ErrorCode::io, arguments.out + " cannot be written to its end: is the disk full?"});
  if ((*reader)->problem()) return fail(*(*reader)->problem());
  std::cerr << count << (arguments.format == "pdn" ? " games\n" : " poses\n");
  if (count == 0) return fail({ErrorCode::not_found, arguments.file + " holds nothing that can be exported so"});
  return kFine;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Writes a capture for other programs");
  command->add_option("format", arguments->format, "csv (poses), pdn (games) or opentrackio (camera)")
      ->required()
      ->check(CLI::IsMember({"csv", "pdn", "opentrackio"}));
  command->add_option("file", arguments->file, "The capture")->required();
  command->add_option("--out", arguments->out, "File to write; - is stdout")->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = run_export(*arguments); });
}

}  // namespace counterpart::vhp
