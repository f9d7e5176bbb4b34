// gauntlet evaluate: simulate given test cases.
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "controllers/registry.h"
#include "master/cases/case_file.h"
#include "master/cli/commands.h"
#include "master/cli/dry_run.h"
#include "master/cli/run_campaign.h"
#include "master/cli/summary.h"
#include "master/report/verdict_text.h"
#include "master/search/search_table.h"
#include "proto/run_codec.h"
#include "sim/arena/validity.h"

namespace gauntlet::master {
namespace {

struct EvaluateOptions : LocalOptions {
  std::vector<std::string> files;
  std::string replicates;
};

// Files in the order given; those that can be simulated also stand in `cases`, with their place in `files`.
struct CaseList {
  std::vector<EvaluatedCase> files;
  std::vector<sim::TestCase> cases;
  std::vector<std::size_t> file_of_case;
};

CaseList LoadCases(CommandContext& context, const EvaluateOptions& options, const Experiment& experiment) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment.scenario);
  CaseList list;
  std::map<std::string, std::vector<std::string>> notices;  // and the files they are about
  for (const std::string& file : options.files) {
    EvaluatedCase& evaluated = list.files.emplace_back();
    evaluated.file = file;
    Result<LoadedCase> loaded = LoadCase(file);
    if (!loaded) {
      evaluated.error = loaded.error().message;
      continue;
    }
    if (!loaded->notice.empty()) notices[loaded->notice].push_back(file);
    if (scenario != nullptr) {
      const auto requirements = scenario->requirements(experiment.scenario_parameters, loaded->test_case);
      if (const auto violation = sim::CheckValidity(loaded->test_case, requirements)) {
        evaluated.refused_rule = sim::NameOf(violation->rule);
        evaluated.error = violation->message;
        continue;
      }
      if (const Status fits = CheckSwarmFits(experiment, loaded->test_case); !fits) {
        evaluated.refused_rule = RuleOf(fits.error().message);
        evaluated.error = fits.error().message;
        continue;
      }
    }
    // `show` knows the case by its file, and by what the file calls it.
    const std::string file_name = std::filesystem::path(file).filename().string();
    if (std::string& name = loaded->test_case.name; name != file_name)
      name = fmt::format("{} ({})", file_name, name);
    list.cases.push_back(std::move(loaded->test_case));
    list.file_of_case.push_back(list.files.size() - 1);
  }
  if (options.running.quiet) return list;
  for (const auto& [notice, files] : notices) {
    const std::string others = files.size() > 1 ? fmt::format(" and {} more", files.size() - 1) : "";
    PrintMessage(context, fmt::format("{}{}: {}", files.front(), others, notice));
  }
  return list;
}

// A run may still be refused when the swarm is set up (no room to spawn): that is the case's fault too.
void NoteRefusal(EvaluatedCase& evaluated) {
  for (const EvaluatedRun& run : evaluated.runs) {
    if (run.result.verdict != sim::Verdict::kRefused || !evaluated.error.empty()) continue;
    evaluated.refused_rule = RuleOf(run.result.message);
    evaluated.error = run.result.message;
  }
}

Status AddRuns(CommandContext& context, const std::string& directory, CaseList& list) {
  std::optional<Error> damaged;
  const Status read = context.campaigns.ForEachRun(directory, [&](const StoredRun& stored) {
    Result<sim::RunResult> result = proto::DecodeStoredResult(stored.result);
    if (damaged) return;
    if (!result || stored.individual < 1 || stored.individual > list.cases.size()) {
      damaged =
          Error{ErrorKind::kCorrupt, fmt::format("run {} of {} does not read back", stored.id, directory)};
      return;
    }
    EvaluatedCase& evaluated = list.files[list.file_of_case[static_cast<std::size_t>(stored.individual) - 1]];
    evaluated.runs.push_back({stored.id, stored.seed, std::move(*result)});
  });
  if (!read) return read;
  if (damaged) return *damaged;
  for (EvaluatedCase& evaluated : list.files) NoteRefusal(evaluated);
  return Ok{};
}

void Print(CommandContext& context, const EvaluateOptions& options, const CaseList& list,
           const CampaignSummary* summary, const std::string& directory) {
  context.out << (options.running.json ? EvaluationJson(list.files, summary, directory)
                                       : EvaluationText(list.files, {context.program, directory}))
              << std::flush;
  for (const EvaluatedCase& evaluated : list.files) {
    if (evaluated.error.empty()) continue;
    std::string message = evaluated.error;
    if (!evaluated.refused_rule.empty()) {
      const std::string rule = evaluated.refused_rule + ": ";
      message =
          fmt::format("{}: refused, {}{}", evaluated.file, message.starts_with(rule) ? "" : rule, message);
    } else if (!message.starts_with(evaluated.file)) {
      message = fmt::format("{}: {}", evaluated.file, message);
    }
    PrintMessage(context, message);
  }
}

// kExitUsage when none of the cases gave a fitness.
ExitCode RunEvaluate(CommandContext& context, const EvaluateOptions& options) {
  for (const ExtraSet& size : SetsOf(options.size)) {
    return Fail(context, InvalidInput(fmt::format(
                             "{} {}: 'evaluate' searches nothing; the runs per case are --replicates K",
                             size.option, size.value)));
  }
  std::vector<ExtraSet> extra = {{"evaluate", "search.algorithm", "cases"}};
  if (!options.replicates.empty()) extra.push_back({"--replicates", "search.replicates", options.replicates});
  const Result<Experiment> experiment = LoadExperimentWith(options.experiment, extra);
  if (!experiment) return Fail(context, experiment.error());
  const std::vector<SearchPlan> searches = {{"", *experiment}};
  Result<CampaignRun> campaign = LocalRun(searches, options);
  if (!campaign) return Fail(context, campaign.error());
  const std::string& directory = campaign->directory;

  CaseList list = LoadCases(context, options, *experiment);
  if (list.cases.empty()) {
    Print(context, options, list, nullptr, directory);
    return kExitUsage;
  }
  if (options.dry_run) return PrintDryRun(context, *campaign, searches, list.cases);
  campaign->run = [&](const SessionOptions& session) {
    return context.campaigns.Start(directory, searches, list.cases, session);
  };
  campaign->report = [&](const SessionReport& report) -> Status {
    if (Status added = AddRuns(context, directory, list); !added) return added;
    Print(context, options, list, &report.summary, directory);
    return Ok{};
  };
  const ExitCode code = RunCampaign(context, *campaign);
  const bool none =
      std::ranges::none_of(list.files, [](const auto& one) { return MeanFitness(one).has_value(); });
  return code == kExitDone && none ? kExitUsage : code;
}

}  // namespace

void AddEvaluate(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("evaluate", "simulate given test cases (case JSON or .argos files)", RunEvaluate);
  AddLocalOptions(command, options, /*sizes=*/false);
  command.add_option("--case", options.files, "case files, .json or .argos; several may follow")
      ->type_name("FILE...")
      ->required();
  AddValue(command, "--replicates", "K", options.replicates, "runs per case, each with its own seed");
  command.footer(
      R"(Simulates each case and prints its fitness (mean of the replicates; lower = tougher). A case that
breaks a validity rule is refused by the rule's name; the others go on. Exit 2 when all were refused.
Of .argos files the arena, the boxes, the number of foot-bots and their start area are read.

Examples:
  gauntlet evaluate flocking --case one-wall.json --replicates 20
  gauntlet evaluate flocking --case cases/*.json --replicates 100 --dry-run
  gauntlet evaluate flocking-improved --case cases/*.argos --json > improved.json)");
}

}  // namespace gauntlet::master
