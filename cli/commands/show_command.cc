// gauntlet show: what came out of a campaign.
#include <malloc.h>

#include <limits>

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

// What is freed on the way stays with the process, which ends soon, and need not be asked of the system
// again: a fifth of the time that 100,000 cases take.
void KeepFreedMemory() {
  constexpr int kAtATime = 32 << 20;  // bytes
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, kAtATime);
}

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
  KeepFreedMemory();
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
  const auto [command, options] = parser.Add("show", "print what a campaign found", RunShow);
  AddDirectory(command, options.directory);
  command.add_flag("--json", options.json, "print everything as one JSON document");
  command.add_flag("--runs", options.runs,
                   "with --json: print every run too, with the columns of 'export' (see its --help)");
  command.add_flag(
      "--types", options.types,
      "print the total failures by the types that the scenario declares (for flocking those of the "
      "thesis) instead");
  command.footer(
      R"(Prints a summary of what is stored: the runs, the fitness by generation, the total failures, the toughest
cases with a run to replay, and the state hash. Campaigns with equal results have equal state hashes.

After 'gauntlet confirm DIR --all-failing' it also lists the different failures, each with a command that draws
it. Two cases are the same failure when most of their runs with fresh seeds fail in the same place. In flocking
this is the corner of the prey's path that is nearest to the last split, in task-partitioning it is where the
robots are. In foraging, two failures are the same when both have a path of beacons, or neither has.

Examples:
  gauntlet show campaigns/flocking-20260131T120000Z
  gauntlet show DIR --json | jq '.population[0].genome'
  gauntlet show DIR --json --runs | jq '.runs[] | select(.total_failure) | .id')");
}

}  // namespace gauntlet
