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

#include "cli/commands.h"
#include "cli/dry_run.h"
#include "cli/given_cases.h"
#include "cli/output/summary.h"
#include "cli/run_campaign.h"
#include "master/campaign/verdict_text.h"
#include "proto/run_codec.h"
#include "search/cases/case_file.h"
#include "search/search_table.h"
#include "study/sets/case_set.h"

namespace gauntlet {
namespace {

struct EvaluateOptions : LocalOptions {
  std::vector<std::string> files;
  std::string from;
  std::string replicates;
};

// Cases in the order given; those that can be simulated also stand in `searches`, with their place in
// `cases`.
struct CaseList {
  std::vector<EvaluatedCase> cases;
  std::vector<SearchPlan> searches;
  std::vector<std::vector<std::size_t>> place_of_case;  // by search
};

// Whether the experiment's swarm can be put into the case; what speaks against it is noted.
bool CanBeSimulated(const Experiment& experiment, const sim::TestCase& test_case, EvaluatedCase& evaluated) {
  const std::optional<CaseRefusal> refusal = RefusalOf(experiment, test_case);
  if (!refusal) return true;
  evaluated.refused_rule = refusal->rule;
  evaluated.error = refusal->message;
  return false;
}

// Adds the case to the newest search.
void AddCase(sim::TestCase test_case, CaseList& list) {
  list.searches.back().cases.push_back(std::move(test_case));
  list.place_of_case.back().push_back(list.cases.size() - 1);
}

CaseList CasesOfFiles(CommandContext& context, const EvaluateOptions& options, const Experiment& experiment) {
  CaseList list{{}, {{"", experiment}}, {{}}};
  std::map<std::string, std::vector<std::string>> notices;  // and the files they are about
  for (const std::string& file : options.files) {
    EvaluatedCase& evaluated = list.cases.emplace_back();
    evaluated.file = file;
    Result<LoadedCase> loaded = LoadCase(file);
    if (!loaded) {
      evaluated.error = loaded.error().message;
      continue;
    }
    if (!loaded->notice.empty()) notices[loaded->notice].push_back(file);
    if (!CanBeSimulated(experiment, loaded->test_case, evaluated)) continue;
    // `show` knows the case by its file, and by what the file calls it.
    const std::string file_name = std::filesystem::path(file).filename().string();
    if (std::string& name = loaded->test_case.name; name != file_name)
      name = fmt::format("{} ({})", file_name, name);
    AddCase(std::move(loaded->test_case), list);
  }
  if (options.running.quiet) return list;
  for (const auto& [notice, files] : notices) {
    const std::string others = files.size() > 1 ? fmt::format(" and {} more", files.size() - 1) : "";
    PrintMessage(context, fmt::format("{}{}: {}", files.front(), others, notice));
  }
  return list;
}

// What distinguishes runs of the experiment from those that the cases come from, as far as the swarm's task
// goes; "" = nothing.
std::string OtherTask(const Experiment& there, const Experiment& here) {
  std::string differences;
  for (const auto& [name, value] : here.scenario_parameters) {
    const auto other = there.scenario_parameters.find(name);
    if (other == there.scenario_parameters.end() || other->second == value) continue;
    differences +=
        fmt::format("{}{} {} there, {} here", differences.empty() ? "" : "; ", name, other->second, value);
  }
  return differences;
}

// One search for each of the campaigns' searches, so that relatives stay together.
Result<CaseList> CasesOfCampaigns(CommandContext& context, const EvaluateOptions& options,
                                  const Experiment& experiment) {
  TRY(const std::vector<CaseSet> sets, ReadCaseSets(options.from));
  CaseList list;
  for (const CaseSet& set : sets) {
    if (set.experiment.scenario != experiment.scenario) {
      return InvalidInput(
          fmt::format("--from {}: its cases are of the scenario '{}', the experiment {} has '{}'", set.place,
                      set.experiment.scenario, experiment.name, experiment.scenario));
    }
    SearchPlan plan{sets.size() > 1 ? set.place : "", experiment};
    if (RowOf(set.experiment).Related()) plan.experiment.search.algorithm = "resimulation";
    plan.experiment.seed += list.searches.size();
    list.searches.push_back(std::move(plan));
    list.place_of_case.emplace_back();
    for (const Individual& member : set.members) {
      EvaluatedCase& evaluated = list.cases.emplace_back();
      evaluated.file = fmt::format("{} individual {}", set.place, member.id);
      if (!CanBeSimulated(experiment, member.test_case, evaluated)) continue;
      sim::TestCase test_case = member.test_case;
      test_case.name = evaluated.file;
      AddCase(std::move(test_case), list);
    }
    if (list.searches.back().cases.empty()) {
      list.searches.pop_back();
      list.place_of_case.pop_back();
    }
    if (options.running.quiet) continue;
    for (const std::string& note : set.notes) PrintMessage(context, note);
    if (const std::string other = OtherTask(set.experiment, experiment); !other.empty()) {
      PrintMessage(context,
                   fmt::format("{}: scenario_parameters differ from the experiment's: {}", set.place, other));
    }
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
  TRY(context.campaigns.ForEachRun(directory, [&](const StoredRun& stored) -> Status {
    Result<sim::RunResult> result = proto::DecodeStoredResult(stored.result);
    const bool known = stored.search >= 1 && stored.search <= list.searches.size() &&
                       stored.individual >= 1 &&
                       stored.individual <= list.place_of_case[stored.search - 1].size();
    if (!result || !known)
      return Error{ErrorKind::kCorrupt, fmt::format("run {} of {} does not read back", stored.id, directory)};
    const std::size_t place =
        list.place_of_case[stored.search - 1][static_cast<std::size_t>(stored.individual) - 1];
    list.cases[place].runs.push_back({stored.id, stored.seed, std::move(*result)});
    return Ok{};
  }));
  for (EvaluatedCase& evaluated : list.cases) NoteRefusal(evaluated);
  return Ok{};
}

void Print(CommandContext& context, const EvaluateOptions& options, const CaseList& list,
           const CampaignSummary* summary, const std::string& directory) {
  context.out << (options.running.json ? EvaluationJson(list.cases, summary, directory)
                                       : EvaluationText(list.cases, {context.program, directory}))
              << std::flush;
  for (const EvaluatedCase& evaluated : list.cases) {
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
Result<ExitCode> RunEvaluate(CommandContext& context, const EvaluateOptions& options) {
  if (options.files.empty() == options.from.empty()) {
    return InvalidInput("which cases? Either --case FILE... or --from DIR[:SUBSET]");
  }
  for (const ExtraSet& size : SetsOf(options.size)) {
    return InvalidInput(fmt::format(
        "{} {}: 'evaluate' searches nothing; the runs per case are --replicates K", size.option, size.value));
  }
  std::vector<ExtraSet> extra = {{"evaluate", "search.algorithm", "cases"}};
  if (!options.replicates.empty()) extra.push_back({"--replicates", "search.replicates", options.replicates});
  TRY(const Experiment experiment, LoadExperimentWith(options.experiment, extra));
  TRY(CaseList list, options.from.empty() ? CasesOfFiles(context, options, experiment)
                                          : CasesOfCampaigns(context, options, experiment));
  if (std::ranges::all_of(list.searches, [](const auto& one) { return one.cases.empty(); })) {
    Print(context, options, list, nullptr, "");
    return kExitUsage;
  }
  TRY(CampaignRun campaign, LocalRun(list.searches, options));
  const std::string& directory = campaign.directory;
  if (options.dry_run) return PrintDryRun(context, campaign, list.searches);
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Start(directory, list.searches, session);
  };
  campaign.report = [&](const SessionReport& report) -> Status {
    TRY(AddRuns(context, directory, list));
    Print(context, options, list, &report.summary, directory);
    return Ok{};
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  const bool none =
      std::ranges::none_of(list.cases, [](const auto& one) { return MeanFitness(one).has_value(); });
  return code == kExitDone && none ? kExitUsage : code;
}

}  // namespace

void AddEvaluate(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("evaluate", "simulate given test cases: files, or those of a campaign", RunEvaluate);
  AddLocalOptions(command, options, /*sizes=*/false);
  command.add_option("--case", options.files, "case files, .json or .argos; several may follow")
      ->type_name("FILE...");
  AddValue(command, "--from", "DIR[:SUBSET]", options.from,
           "the cases of campaigns instead, subsets as in 'gauntlet compare' (default: final)");
  AddValue(command, "--replicates", "K", options.replicates, "runs per case, each with its own seed");
  command.footer(
      R"(Simulates each case and prints its fitness (mean of the replicates; lower = tougher). A case that
breaks a validity rule is refused by the rule's name; the others go on. Exit 2 when all were refused.
Of .argos files the arena, the boxes, the foot-bots and where they start are read.

With --from every individual that has a run in the subset is simulated once (K times with --replicates),
clones included: a population of twenty gives twenty cases, as in the thesis, also when some are copies of
each other. Seeds are fresh: no run of a search has them. What comes of it is a campaign on which 'compare',
'show' and 'replay' work; it has one search for each search that the cases come from, and 'compare' knows
that the members of one evolution's population are relatives.

Examples:
  gauntlet evaluate flocking --case one-wall.json --replicates 20
  gauntlet evaluate flocking --case cases/*.json --replicates 100 --dry-run
  gauntlet evaluate flocking-improved --case cases/*.argos --json > improved.json
  gauntlet evaluate flocking --from campaigns/evolved-1,campaigns/evolved-2 --dir campaigns/f-f
  gauntlet evaluate flocking --from campaigns/evolved-1 --set controller=flocking-improved
  gauntlet evaluate flocking --from campaigns/random:worst:100)");
}

}  // namespace gauntlet
