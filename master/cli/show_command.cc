// gauntlet show: what came out of a campaign.
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {
namespace {

struct ShowOptions {
  std::string directory;
  bool json = false;
};

ExitCode RunShow(CommandContext& context, const ShowOptions& options) {
  const Result<CampaignSummary> summary = context.campaigns.Read(options.directory);
  if (!summary) return Fail(context, summary.error());
  PrintAsOf(context, options.directory, summary->as_of);
  PrintSummary(context, *summary, options.directory, options.json);
  return kExitDone;
}

}  // namespace

void AddShow(CommandParser& parser) {
  const auto [command, options] = parser.Add("show", "what came out of a campaign", RunShow);
  AddDirectory(command, options.directory);
  command.add_flag("--json", options.json, "everything as one JSON document");
  command.footer(
      R"(Sums up what is stored: runs, fitness by generation, total failures, the toughest cases with a run to
replay, and the state hash, which is equal for equal outcomes.

Examples:
  gauntlet show campaigns/flocking-20260131T120000Z
  gauntlet show DIR --json | jq '.population[0].genome')");
}

}  // namespace gauntlet::master
