#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "protocol/codec/names.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

// Asks the program itself what may come next, so that there is no second list of its words.
constexpr const char* kBeforeControls = R"(_vhp() {
  local current=${COMP_WORDS[COMP_CWORD]}
  local help
  help=$("${COMP_WORDS[@]:0:COMP_CWORD}" --help 2>/dev/null)
  local words
  words=$(sed -nE '
    s/^  (-[a-z],)?(--[a-z-]+).*/\2/p
    /^Subcommands:/,$ s/^  ([a-z_]+)( .*|$)/\1/p' <<<"$help")
  if [ "${COMP_WORDS[1]}" = send ] && [ "${COMP_WORDS[COMP_CWORD - 1]}" = control ]; then
    words=")";
constexpr const char* kAfterControls = R"("
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [ ${#COMPREPLY[@]} -eq 0 ]; then mapfile -t COMPREPLY < <(compgen -f -- "$current"); fi
}
complete -o filenames -F _vhp vhp
)";

std::string bash_completion() {
  std::string controls = all_names<ControlKind>();
  std::erase(controls, ',');
  return kBeforeControls + controls + kAfterControls;
}

}  // namespace

void add_completion(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("completion", "Completion of vhp for bash: eval \"$(vhp completion)\"");
  command->callback([] { std::cout << bash_completion(); });
}

}  // namespace counterpart::vhp
