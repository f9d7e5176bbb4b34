// gauntlet status: what a campaign does now.
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/options.h"
#include "master/cli/status_text.h"

namespace gauntlet::master {
namespace {

struct StatusOptions {
  std::string directory;
  bool json = false;
};

ExitCode RunStatus(CommandContext& context, const StatusOptions& options) {
  const Result<std::string> text = CurrentStatus(context, options.directory, options.json);
  if (!text) return Fail(context, text.error());
  context.out << *text << std::flush;
  return kExitDone;
}

}  // namespace

void AddStatus(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("status", "what runs where, since when, and why nothing runs", RunStatus);
  AddDirectory(command, options.directory);
  command.add_flag("--json", options.json, "everything as one JSON document");
  command.footer(
      R"(Read from what the living master writes every second; without one, from what is stored. Of a submitted campaign
it lists the jobs with Slurm's state and reason.

Examples:
  gauntlet status DIR
  gauntlet status DIR --json | jq -r .why_nothing_runs)");
}

}  // namespace gauntlet::master
