// gauntlet confirm: do cases fail again, with seeds that took no part in finding them?
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "cli/commands.h"
#include "cli/given_cases.h"
#include "cli/output/confirmation_table.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

struct ConfirmOptions : RunningOptions {
  std::string directory;
  std::vector<std::string> cases;
  bool all_failing = false;
  bool elites = false;
  std::string replicates;
};

// The cases that are asked about: runs by their numbers, and files.
Result<QuestionedCampaign> CasesOf(CommandContext& context, const ConfirmOptions& options) {
  if (int{!options.cases.empty()} + int{options.all_failing} + int{options.elites} != 1) {
    return InvalidInput("which cases? Either RUN_ID or FILE..., or --all-failing, or --elites");
  }
  if (options.elites) {
    Result<QuestionedCampaign> elites = PopulationCases(options.directory);
    if (elites && elites->cases.empty())
      return InvalidInput(fmt::format(
          "{}: its search has found nothing that is worth keeping, so there is no case to confirm",
          options.directory));
    return elites;
  }
  if (options.all_failing) {
    Result<QuestionedCampaign> failing = FailingCases(options.directory);
    if (failing && failing->cases.empty())
      return InvalidInput(
          fmt::format("{}: no run has failed, so there is no case to confirm", options.directory));
    return failing;
  }
  return GivenCases(context, options.directory, options.cases);
}

Result<int> ParseReplicates(const std::string& text) {
  if (text.empty()) return 0;
  const auto number = ParseNumber<int>(text);
  if (number && *number >= 1 && *number <= 100000) return *number;
  return InvalidInput(fmt::format("--replicates {}: a whole number from 1 to 100000 is needed", text));
}

// What is known by now of the cases that were asked about.
Status Print(CommandContext& context, const ConfirmOptions& options, const QuestionedCampaign& questioned) {
  TRY(std::vector<Confirmation> known, ReadConfirmations(options.directory));
  std::vector<std::uint64_t> wanted;
  for (const CaseInQuestion& one : questioned.cases) {
    wanted.push_back(ConfirmationKey(questioned.plans[one.search].experiment, one.test_case));
  }
  std::vector<Confirmation> shown;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto found = std::ranges::find(known, wanted[i], &Confirmation::key);
    if (found == known.end()) continue;
    shown.push_back(*found);
    shown.back().name = questioned.cases[i].name;
  }
  context.out << (options.json ? JsonText({{"cases", ConfirmationsJson(shown)}}) : ConfirmationsText(shown))
              << std::flush;
  return Ok{};
}

Result<ExitCode> RunConfirm(CommandContext& context, const ConfirmOptions& options) {
  TRY(const int replicates, ParseReplicates(options.replicates));
  TRY(const int workers, ParseWorkers(options.workers));
  TRY(const QuestionedCampaign questioned, CasesOf(context, options));
  TRY(const std::vector<Confirmation> known, ReadConfirmations(options.directory));
  const CallPlan plan = PlanConfirmation(options.directory, questioned, known, replicates);
  if (plan.searches.empty()) {
    TRY(Print(context, options, questioned));
    return kExitDone;
  }

  CampaignRun campaign = RunOfCall(context, plan, workers, options);
  campaign.report = [&](const SessionReport&) { return Print(context, options, questioned); };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddConfirm(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("confirm", "do cases fail again with fresh seeds, and how often?", RunConfirm);
  AddDirectory(command, options.directory);
  command.add_option("CASE", options.cases, "runs of the campaign whose cases are meant, or case files");
  command.add_flag("--all-failing", options.all_failing, "every case of the campaign that has failed once");
  command.add_flag("--elites", options.elites,
                   "the cases that the search has ended with: its population, or the elites of an archive");
  AddValue(command, "--replicates", "N", options.replicates,
           "exactly N runs per case, for a narrower interval");
  AddRunningOptions(command, options);
  command.footer(
      R"(A search keeps what failed once, and some of that was luck. Here every case is simulated with seeds that
took no part in choosing it, until it has failed 5 times or not failed 6 times (at most 10 runs). What counts
as failing is the scenario's: a total failure; of foraging, that no item reached the nest.

Verdicts: fail (confirmed: in at least half of the runs), flaky (less often), pass (never), error (a run ended
without a result). All is kept in DIR/confirm, is shown by 'show', and leaves the campaign as it was; a case
that is known already is not simulated again. After Ctrl-C the same command goes on.

Examples:
  gauntlet confirm DIR 812
  gauntlet confirm DIR --all-failing --json
  gauntlet confirm DIR --elites
  gauntlet confirm DIR 812 817 --replicates 100
  gauntlet confirm DIR my-case.json)");
}

}  // namespace gauntlet
