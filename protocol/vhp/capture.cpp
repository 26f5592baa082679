#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "protocol/capture/checkup.hpp"
#include "protocol/capture/session_reader.hpp"
#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

using nlohmann::json;

struct CaptureArguments {
  std::string file, second;
  std::string type;
  std::uint64_t limit = 0;
  bool json = false;
};

struct Tally {
  std::uint64_t messages = 0, in = 0, out = 0;
  std::int64_t first_ns = 0, last_ns = 0;
  std::map<std::string, std::uint64_t> types;
};

Tally count(SessionReader& reader) {
  Tally tally;
  while (const auto recorded = reader.next()) {
    if (tally.messages++ == 0) tally.first_ns = recorded->log_ns;
    tally.last_ns = recorded->log_ns;
    ++(recorded->incoming ? tally.in : tally.out);
    ++tally.types[(recorded->incoming ? "in/" : "out/") + std::string(name_of(type_of(recorded->message)))];
  }
  return tally;
}

int capture_info(const CaptureArguments& arguments) {
  auto reader = SessionReader::open(arguments.file);
  if (!reader) return fail(reader.error());
  const Tally tally = count(**reader);
  const bool good = !(*reader)->problem();
  const double seconds = static_cast<double>(tally.last_ns - tally.first_ns) / 1e9;
  json out{{"file", arguments.file},
           {"complete", (*reader)->file().complete()},
           {"chunks", (*reader)->file().chunks()},
           {"messages", tally.messages},
           {"in", tally.in},
           {"out", tally.out},
           {"seconds", seconds},
           {"passed_over", (*reader)->passed_over()},
           {"problem", good ? "" : (*reader)->problem()->message},
           {"types", tally.types},
           {"metadata", (*reader)->file().metadata()}};
  if (arguments.json) {
    std::cout << out << '\n';
  } else {
    std::cout << arguments.file << ": " << tally.messages << " messages in " << seconds << " s, "
              << (*reader)->file().chunks() << " chunks, " << (good ? "complete" : "damaged") << '\n';
    for (const auto& [name, values] : (*reader)->file().metadata()) {
      for (const auto& [key, value] : values) std::cout << "  " << name << '.' << key << " = " << value << '\n';
    }
    for (const auto& [type, number] : tally.types) std::cout << "  " << type << "  " << number << '\n';
  }
  return good ? kFine : fail(*(*reader)->problem());
}

int capture_cat(const CaptureArguments& arguments) {
  auto reader = SessionReader::open(arguments.file);
  if (!reader) return fail(reader.error());
  std::uint64_t shown = 0;
  while (const auto recorded = (*reader)->next()) {
    const auto type = name_of(type_of(recorded->message));
    if (!arguments.type.empty() && type != arguments.type) continue;
    const json line{{"t_ns", recorded->log_ns},
                    {"direction", recorded->incoming ? "in" : "out"},
                    {"peer", recorded->peer},
                    {"seq", recorded->seq},
                    {"type", type},
                    {"body", to_json(recorded->message)}};
    std::cout << line.dump(-1, ' ', false, json::error_handler_t::replace) << '\n';
    if (++shown == arguments.limit || !std::cout) break;
  }
  const bool all_read = arguments.limit == 0 || shown < arguments.limit;
  return all_read && (*reader)->problem() ? fail(*(*reader)->problem()) : kFine;
}

int capture_doctor(const CaptureArguments& arguments) {
  const auto checkup = check_capture(arguments.file);
  if (!checkup) return fail(checkup.error());
  if (arguments.json) {
    std::cout << json{{"messages", checkup->messages}, {"damage", checkup->damage}, {"findings", checkup->findings}}
              << '\n';
  } else {
    std::cout << arguments.file << ": " << checkup->messages << " messages\n";
    for (const std::string& line : checkup->damage) std::cout << "damage: " << line << '\n';
    for (const std::string& line : checkup->findings) std::cout << "finding: " << line << '\n';
    if (checkup->damage.empty() && checkup->findings.empty()) std::cout << "nothing is wrong with it\n";
    if (!checkup->damage.empty()) {
      std::cout << "what is whole can be saved: vhp capture recover " << arguments.file << " NEW.mcap\n";
    }
  }
  return checkup->damage.empty() ? kFine : kFailed;
}

int capture_recover(const CaptureArguments& arguments) {
  if (arguments.file == arguments.second) {
    return fail({ErrorCode::invalid_argument, "the recovered capture needs another name"});
  }
  const auto recovery = recover_capture(arguments.file, arguments.second);
  if (!recovery) return fail(recovery.error());
  if (arguments.json) {
    std::cout << json{{"messages", recovery->messages},
                      {"passed_over", recovery->passed_over},
                      {"problem", recovery->problem}}
              << '\n';
  } else {
    std::cout << recovery->messages << " messages in " << arguments.second << ", read again and found whole";
    if (recovery->passed_over > 0) std::cout << "; " << recovery->passed_over << " damaged ones left out";
    std::cout << '\n' << (recovery->problem.empty() ? "the old file was whole, too" : recovery->problem) << '\n';
  }
  return kFine;
}

int capture_diff(const CaptureArguments& arguments) {
  const auto differences =
      compare_captures(arguments.file, arguments.second, arguments.limit == 0 ? 20 : arguments.limit);
  if (!differences) return fail(differences.error());
  if (arguments.json) {
    std::cout << json{{"same", differences->empty()}, {"differences", *differences}} << '\n';
  } else {
    for (const std::string& line : *differences) std::cout << line << '\n';
    if (differences->empty()) std::cout << "both say the same\n";
  }
  return differences->empty() ? kFine : kFailed;
}

}  // namespace

void add_capture(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CaptureArguments>();
  CLI::App* command = app.add_subcommand("capture", "Looks into captures");
  command->require_subcommand(1);

  CLI::App* info_command = command->add_subcommand("info", "What a capture holds, and whether it is whole");
  info_command->add_option("file", arguments->file, "The capture")->required();
  info_command->add_flag("--json", arguments->json, "As one JSON object");
  info_command->callback([arguments, &exit_code] { exit_code = capture_info(*arguments); });

  CLI::App* cat_command = command->add_subcommand("cat", "Every message as a JSON line");
  cat_command->add_option("file", arguments->file, "The capture")->required();
  cat_command->add_option("--type", arguments->type, "Only this type, for example game_event")
      ->check([](const std::string& name) {
        return from_name<MessageType>(name) ? "" : "must be one of " + all_names<MessageType>();
      });
  cat_command->add_option("--limit", arguments->limit, "Stop after so many lines (0: never)");
  cat_command->add_flag("--json", arguments->json, "(always)");
  CLI::App* doctor_command = command->add_subcommand("doctor", "Looks for damage, gaps and unanswered commands");
  doctor_command->add_option("file", arguments->file, "The capture")->required();
  doctor_command->add_flag("--json", arguments->json, "As one JSON object");
  doctor_command->callback([arguments, &exit_code] { exit_code = capture_doctor(*arguments); });

  CLI::App* recover_command = command->add_subcommand("recover", "Saves what is whole in a damaged capture");
  recover_command->add_option("file", arguments->file, "The damaged capture")->required();
  recover_command->add_option("new", arguments->second, "The capture to write")->required();
  recover_command->add_flag("--json", arguments->json, "Result as JSON");
  recover_command->callback([arguments, &exit_code] { exit_code = capture_recover(*arguments); });

  CLI::App* diff_command = command->add_subcommand("diff", "Whether two captures say the same, stamps apart");
  diff_command->add_option("a", arguments->file, "A capture")->required();
  diff_command->add_option("b", arguments->second, "Another one")->required();
  diff_command->add_option("--limit", arguments->limit, "Differences to show; 0: 20");
  diff_command->add_flag("--json", arguments->json, "Result as JSON");
  diff_command->callback([arguments, &exit_code] { exit_code = capture_diff(*arguments); });

  cat_command->callback([arguments, &exit_code] { exit_code = capture_cat(*arguments); });
}

}  // namespace counterpart::vhp
