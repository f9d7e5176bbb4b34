// gauntlet repair: which parameter of a controller is at fault, and what would mend it?
#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "cli/argos_files.h"
#include "cli/commands.h"
#include "cli/output/output_file.h"
#include "cli/run_campaign.h"
#include "master/directory/campaign_directory.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "study/questions/empty_arena.h"
#include "study/repairs/repair_cases.h"
#include "study/repairs/repair_corpus.h"
#include "study/repairs/repair_result.h"

namespace gauntlet {
namespace {

constexpr std::string_view kParameters = "controller_parameters.";
constexpr const char* kRandom = "3000";

struct RepairOptions : LocalOptions {
  std::string corpus;
  std::string from;
  std::string held_out;
  std::string parameters;
  std::string freeze;
  std::vector<std::string> vary;
  std::string budget;
  std::string random;
  std::string fresh;
  std::string output;
  ArgosFilesOptions argos;

  bool AsksNothing() const {
    return corpus.empty() && from.empty() && held_out.empty() && parameters.empty() && freeze.empty() &&
           vary.empty() && budget.empty() && random.empty() && fresh.empty() && experiment.sets.empty() &&
           !dry_run;
  }
};

std::vector<std::string> ListOf(const std::string& text) {
  return text.empty() ? std::vector<std::string>() : Split(text, ',');
}

// The keys of the controller's parameters that can vary.
std::vector<Key> ParametersOf(const Experiment& experiment) {
  std::vector<Key> keys = AllKeysOf(experiment);
  std::erase_if(keys, [](const Key& key) { return !key.path.starts_with(kParameters); });
  return keys;
}

// Of parameters that are named, without what all keys of them begin with. Error: there is no such parameter.
Result<std::set<std::string>> NamedParameters(const char* option, const std::string& text,
                                              const std::vector<Key>& keys) {
  std::set<std::string> paths;
  std::vector<std::string> names;
  for (const Key& key : keys) names.push_back(key.path.substr(kParameters.size()));
  for (const std::string& word : ListOf(text)) {
    const std::string name = word.starts_with(kParameters) ? word.substr(kParameters.size()) : word;
    if (std::ranges::count(names, name) == 0)
      return InvalidInput(fmt::format("{} {}: {}", option, text, UnknownName("parameter", name, names)));
    paths.insert(std::string(kParameters) + name);
  }
  return paths;
}

// What a parameter's row allows, as --vary takes it; "" where that is a point. On the logarithmic scale, and
// not beyond a hundredth and a hundred times the value, where it spans thousandfold. Where it has no range,
// from a tenth to ten times the value.
std::string RangeOf(const Key& key, const Experiment& experiment) {
  constexpr double kWide = 1000.0;
  constexpr double kFar = 100.0;
  constexpr double kUnbounded = 1e9;  // what a number of an .argos file, which has no range, is given
  constexpr double kNear = 10.0;
  if (key.type == KeyType::kFlag) return key.path + "=false|true";
  const double value = NumberOf(key.get(experiment));
  double low = key.min;
  double high = key.max;
  if (low <= -kUnbounded || high >= kUnbounded)
    std::tie(low, high) = std::minmax({value / kNear, value * kNear});  // a point where it is 0
  const bool log = low > 0.0 && high / low >= kWide;
  if (log) {
    low = std::max(low, value / kFar);
    high = std::min(high, value * kFar);
  }
  return low < high ? fmt::format("{}={}..{}{}", key.path, low, high, log ? ":log" : "") : "";
}

Result<std::string> VariedOf(const RepairOptions& options, const Experiment& experiment) {
  const std::vector<Key> keys = ParametersOf(experiment);
  if (keys.empty())
    return InvalidInput(
        fmt::format("the controller '{}' has no parameter that could be repaired", experiment.controller));
  if (!options.parameters.empty() && !options.freeze.empty())
    return InvalidInput("--parameters says what may change, --freeze what may not: give one of them");
  TRY(const auto only, NamedParameters("--parameters", options.parameters, keys));
  TRY(const auto frozen, NamedParameters("--freeze", options.freeze, keys));
  std::set<std::string> given;
  std::vector<std::string> texts = options.vary;
  if (!texts.empty()) {
    TRY(const auto varied, ParseVariedKeys(texts, AllKeysOf(experiment), experiment));
    for (const VariedKey& key : varied) {
      if (!key.key.path.starts_with(kParameters))
        return InvalidInput(
            fmt::format("--vary {}: a repair changes the controller: {}NAME", key.ToText(), kParameters));
      if (frozen.contains(key.key.path))
        return InvalidInput(fmt::format("--vary {}: --freeze says that it may not change", key.ToText()));
      given.insert(key.key.path);
    }
  }
  for (const Key& key : keys) {
    if (given.contains(key.path) || frozen.contains(key.path)) continue;
    if (!only.empty() && !only.contains(key.path)) continue;
    const std::string range = RangeOf(key, experiment);
    if (!range.empty()) {
      texts.push_back(range);
    } else if (only.contains(key.path)) {
      return InvalidInput(
          fmt::format("--parameters {}: the range of {} is a point", options.parameters, key.path));
    }
  }
  if (texts.empty())
    return InvalidInput(fmt::format("--freeze {}: no parameter is left that may change", options.freeze));
  return fmt::format("{}", fmt::join(texts, " "));
}

// What would be noticed only when all is simulated.
Status CheckTakenHome(const RepairOptions& options, const Experiment& experiment) {
  if (!options.output.empty()) {
    TRY(const OutputFile writable, OutputFile::Open(options.output));
  }
  TRY(const std::string controllers,
      ControllersWithParameters(SpecOf(experiment, EmptyArena(experiment.arena), 0), options.argos));
  return Ok{};
}

Result<SearchPlan> PlanRepair(CommandContext& context, const RepairOptions& options) {
  std::vector<ExtraSet> extra = {{"repair", "search.replicates", "1"}};
  if (!options.budget.empty()) extra.push_back({"--budget", "repair.runs", options.budget});
  if (!options.fresh.empty()) extra.push_back({"--fresh", "repair.fresh", options.fresh});
  TRY(Experiment experiment, LoadExperimentWith(options.experiment, extra));
  if (options.corpus.empty() && options.from.empty())
    return InvalidInput(
        "which cases are to be mended? --corpus FOLDER, or --from DIR of campaigns that found some");
  if (!options.corpus.empty() && !options.from.empty())
    return InvalidInput("--corpus and --from both say which cases are to be mended: give one of them");
  const int fresh = experiment.repair.fresh;
  if (fresh > 0 && fresh < experiment.search.population)
    return InvalidInput(
        fmt::format("--fresh {}: a genetic search needs {} runs or more, one generation; 0: none", fresh,
                    experiment.search.population));
  experiment.repair.search = experiment.search.algorithm;
  experiment.search.algorithm = "repair";
  TRY(experiment.repair.vary, VariedOf(options, experiment));
  TRY(CheckTakenHome(options, experiment));
  const std::string random_text = options.random.empty() ? kRandom : options.random;
  const auto random = ParseNumber<std::size_t>(random_text);
  if (!random || *random > 1'000'000)
    return InvalidInput(fmt::format("--random {}: a whole number from 0 to 1000000 is needed", random_text));
  TRY(ChosenRepairCases chosen, ChooseRepairCases({.corpus = options.corpus,
                                                   .from = ListOf(options.from),
                                                   .held_out = ListOf(options.held_out),
                                                   .random = *random},
                                                  experiment));
  for (const std::string& note : chosen.notes) PrintMessage(context, note);
  SearchPlan plan{"", experiment, std::move(chosen.cases)};
  TRY(const auto search, MakeSearch(plan.experiment, plan.cases));
  const RepairPlan& repair = search->Repair()->plan();
  if (options.dry_run) {
    std::string cost = fmt::format("{} varied; of the runs at most {} search, {} draw the curves, {} prove",
                                   Counted(repair.varied.size(), "parameter"),
                                   FormatCount(static_cast<std::uint64_t>(repair.runs)),
                                   FormatCount(repair.RunsOfCurves()), FormatCount(repair.RunsOfProof()));
    if (fresh > 0)
      cost += fmt::format(
          "; two new searches against the original and two against the repaired controller add {} each",
          FormatCount(static_cast<std::uint64_t>(fresh)));
    PrintMessage(context, cost);
    return plan;
  }
  TRY(const FailureTally empty, FirstEmptyRuns(plan.experiment, /*all=*/false));
  if (empty.failures == empty.runs() && empty.runs() > 0)
    return InvalidInput(fmt::format(
        "the controller fails without any obstacle, in {} of {} runs of the empty arena: a repair in cases "
        "with obstacles would say nothing of them",
        empty.failures, empty.runs()));
  return plan;
}

// What one takes home of a repair: the experiment, the corpus, and the controllers of an ARGoS file.
Status TakeHome(const RepairOptions& options, const Repair& repair, const std::string& dir) {
  TRY(WriteRepairedCorpus(repair, dir, dir + "/corpus"));
  const std::string toml = RepairedToml(repair, dir);
  const Experiment repaired = RepairedExperiment(repair);
  TRY(const std::string controllers,
      ControllersWithParameters(SpecOf(repaired, EmptyArena(repaired.arena), repaired.seed), options.argos));
  for (const auto& [file, text] :
       {std::pair("repaired.toml", toml), std::pair("controllers.xml", controllers)}) {
    const std::string kept = fmt::format("{}/{}", dir, file);
    std::error_code none;
    const bool asked_for =
        file == std::string_view("controllers.xml") && !options.argos.controller_file.empty();
    if (text.empty() || (!asked_for && std::filesystem::exists(kept, none))) continue;
    TRY(WriteFileAtomically(kept, text, kReadableByAll));
  }
  return options.output.empty() ? Status(Ok{}) : WriteOutputFile(options.output, toml);
}

Result<ExitCode> Tell(CommandContext& context, const RepairOptions& options, const std::string& dir) {
  TRY(const Repair repair, ReadRepair(dir));
  if (repair.finished) {
    TRY(TakeHome(options, repair, dir));
  } else if (!options.output.empty()) {
    PrintMessage(context, options.output + " was not written: the repair has not come to its end");
  }
  if (options.running.json) {
    context.out << RepairJson(repair, dir);
  } else {
    for (const Section& section : TellRepair(repair, dir, context.program)) context.out << ToText(section);
  }
  context.out << std::flush;
  return repair.finished && !IsMended(repair) ? kExitNegative : kExitDone;
}

// The searches that begin anew against what came of it, unless they have come to their end; then tells all.
Result<ExitCode> ProveAndTell(CommandContext& context, const RepairOptions& options, const std::string& dir) {
  TRY(const Repair repair, ReadRepair(dir));
  const int runs = repair.experiment.repair.fresh;
  if (!repair.finished || runs == 0 || !repair.fresh.empty()) return Tell(context, options, dir);
  TRY(TakeHome(options, repair, dir));
  const std::vector<SearchPlan> searches = ProofSearches(repair, runs);
  CampaignRun campaign;
  campaign.directory = ProofOf(dir);
  TRY(UseWorkers(context, options.running, repair.experiment, {.parent = dir}, campaign));
  campaign.announcement =
      fmt::format("{} searches begin anew against the original and the repaired controller, {}, in {}",
                  searches.size(), campaign.WorkersText(), campaign.directory);
  campaign.goes_on_by = fmt::format("repair {}", PastedPath(dir));
  campaign.serving = options.running;
  const bool begun = CampaignDirectory::IsCampaign(campaign.directory);
  campaign.run = [&](const SessionOptions& session) {
    return begun ? context.campaigns.Resume(campaign.directory, session)
                 : context.campaigns.Start(campaign.directory, searches, session);
  };
  ExitCode told = kExitDone;
  campaign.report = [&](const SessionReport& report) -> Status {
    if (report.end == CampaignEnd::kStopped) return Ok{};
    TRY(told, Tell(context, options, dir));
    return Ok{};
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  return code == kExitDone ? told : code;
}

Result<ExitCode> RunRepair(CommandContext& context, const RepairOptions& options) {
  const std::string& first = options.experiment.experiment;
  if (CampaignDirectory::IsCampaign(first)) {
    if (!options.AsksNothing())
      return InvalidInput(first + " is a campaign: what it repairs is decided, it is told again alone");
    return ProveAndTell(context, options, first);
  }
  TRY(const SearchPlan plan, PlanRepair(context, options));
  return RunAndTell(context, {plan}, options,
                    [&](const std::string& directory) { return ProveAndTell(context, options, directory); });
}

}  // namespace

void AddRepair(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("repair", "which parameter of a controller is at fault, and what would mend it?", RunRepair);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(command, "--corpus", "FOLDER", options.corpus,
           "failing cases of a corpus ('gauntlet corpus add')");
  AddValue(command, "--from", "DIR[,DIR]", options.from, "failing cases of campaigns");
  AddValue(
      command, "--held-out", "DIR[,DIR]", options.held_out,
      "campaigns whose failing cases judge (default: half of the searches, or lineages, of those above)");
  AddValue(command, "--parameters", "A,B", options.parameters,
           "parameters that may change (default: all of the controller)");
  AddValue(command, "--freeze", "A,B", options.freeze, "parameters that may not change");
  AddValue(
      command, "--vary", "KEY=RANGE", options.vary,
      "a range instead of the parameter's own: KEY=LOW..HIGH, with ':log' behind it, or KEY=A|B; repeatable");
  AddValue(command, "--budget", "RUNS", options.budget,
           "runs of the search (default: 5000); explanation and proof come on top, --dry-run tells them");
  AddValue(command, "--random", "N", options.random, "random cases that judge (default: 3000)");
  AddValue(
      command, "--controller-file", "FILE", options.argos.controller_file,
      "write <controllers> of this .argos or XML file with the repaired parameters to DIR/controllers.xml "
      "(of an adopted project they are its own file's)");
  AddValue(command, "--controller", "ID", options.argos.controller,
           "repair the <params> of the controller of this id in that file");
  AddValue(
      command, "--fresh", "RUNS", options.fresh,
      "runs of each new search against the original and the repaired controller (default: 1000; 0: none)");
  AddValue(command, "-o,--output", "FILE", options.output,
           "write the experiment with the repaired parameters (it is DIR/repaired.toml, too)");
  command.footer(
      R"(Looks for values of the controller's parameters with which it fails less in half of the failing cases, and no
more in random ones (CMA-ES over their ranges; all settings are simulated with common seeds). The other half of the
failing cases, and fresh random ones, take no part and judge. Contacts of the robots may grow by a tenth, and runs to
the time limit by a hundredth.

It explains by each parameter alone at nine values, where the search begins, and by the repaired parameters without
each. Exit 1 when held-out failures are fewer by less than 5 % (its parameters do not mend the controller, its rules
have to change), and where it is not shown that they are fewer: within chance, or in less than ten held-out cases. In
place of EXPERIMENT may stand the directory of such a campaign, to tell it again.

Examples:
  gauntlet repair flocking --from campaigns/a,campaigns/b --dir campaigns/repair
  gauntlet repair flocking --corpus corpus --freeze bird_speed,separation_distance -o flocking-repaired.toml
  gauntlet repair my.toml --from campaigns/mine --vary controller_parameters.gain=0.1..10:log --budget 2000 --dry-run)");
}

}  // namespace gauntlet
