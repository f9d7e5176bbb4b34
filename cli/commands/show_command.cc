// gauntlet show: what came out of a campaign.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/output/summary.h"
#include "cli/run_campaign.h"
#include "report/tables/exported_tables.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

struct ShowOptions {
  std::string directory;
  bool json = false;
  bool runs = false;
  bool types = false;
};

// The summary's JSON, continued by all runs, of one and the same moment.
Result<ExitCode> ShowWithRuns(CommandContext& context, const ShowOptions& options) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(options.directory));
  TRY(const CampaignSummary summary, Summarise(campaign.plans, *campaign.view.store));
  std::string text;
  TRY(WriteTable(campaign, {.what = Exported::kRuns, .format = TableFormat::kJson},
                 SummaryJson(summary, {}, options.directory), [&](std::string_view bytes) -> Status {
                   text += bytes;
                   return Ok{};
                 }));
  PrintAsOf(context, options.directory, campaign.view.as_of);
  context.out << text << std::flush;
  return kExitDone;
}

Result<ExitCode> RunShow(CommandContext& context, const ShowOptions& options) {
  if (IsStudy(options.directory)) {
    return InvalidInput(
        fmt::format("{0} holds a study: its campaigns are {0}/searches and "
                    "{0}/evaluations, its report is given by 'gauntlet resume {0}'",
                    options.directory));
  }
  if (options.runs && !options.json)
    return InvalidInput("--runs lists every run: it needs --json, or use 'export --format csv'");
  if (options.types && options.json)
    return InvalidInput("--types prints a table for people: --json has them as failure_types anyway");
  if (options.runs) return ShowWithRuns(context, options);
  TRY(const CampaignSummary summary, context.campaigns.Read(options.directory));
  PrintAsOf(context, options.directory, summary.as_of);
  if (options.types) {
    context.out << TypesText(summary) << std::flush;
    return kExitDone;
  }
  TRY(PrintSummary(context, summary, options.directory, options.json));
  return kExitDone;
}

}  // namespace

void AddShow(CommandParser& parser) {
  const auto [command, options] = parser.Add("show", "what came out of a campaign", RunShow);
  AddDirectory(command, options.directory);
  command.add_flag("--json", options.json, "everything as one JSON document");
  command.add_flag("--runs", options.runs,
                   "with --json: every run too, with the names of 'export' (see its --help)");
  command.add_flag(
      "--types", options.types,
      "instead: the total failures by the types that the scenario declares (for flocking those of "
      "the thesis)");
  command.footer(
      R"(Sums up what is stored: runs, fitness by generation, total failures, the toughest cases with a run to
replay, and the state hash, which is equal for equal outcomes.

After 'gauntlet confirm DIR --all-failing' it also says how many different failures the cases are, a line for
each with a command that shows it. Two cases are the same failure when most of their runs with fresh seeds fail
at the same place (flocking: the corner of the prey's way nearest to the last split; task-partitioning: where
the robots are), or, in foraging, in the same way (with or without a path of beacons).

Examples:
  gauntlet show campaigns/flocking-20260131T120000Z
  gauntlet show DIR --json | jq '.population[0].genome'
  gauntlet show DIR --json --runs | jq '.runs[] | select(.total_failure) | .id')");
}

}  // namespace gauntlet
