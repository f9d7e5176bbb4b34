// gauntlet fit: settings under which the simulated swarm behaves as it was measured.
#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/parse_number.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/output/output_file.h"
#include "cli/run_campaign.h"
#include "cli/study_run.h"
#include "master/directory/campaign_directory.h"
#include "proto/json_text.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/fits/fit_text.h"
#include "study/fits/prediction.h"
#include "study/fits/target_file.h"
#include "study/study_report.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

struct FitOptions : LocalOptions {
  std::string targets;
  std::vector<std::string> vary;
  std::string budget;
  std::string output;
  std::string predict;
  std::string draws;
  bool print = false;
};

Result<int> NumberFrom(const char* option, const std::string& text, int most, int otherwise) {
  if (text.empty()) return otherwise;
  const auto number = ParseNumber<int>(text);
  if (number && *number >= 1 && *number <= most) return *number;
  return InvalidInput(fmt::format("{} {}: a whole number from 1 to {} is needed", option, text, most));
}

// What a new campaign is made of.
Result<SearchPlan> PlanFit(CommandContext& context, const FitOptions& options) {
  TRY(Experiment experiment, LoadExperimentWith(options.experiment, {}));
  TRY(experiment.fit.runs, NumberFrom("--budget", options.budget, 100'000'000, experiment.fit.runs));
  const bool is_fit = Reads(RowOf(experiment).info, "fit.vary");
  if (is_fit && options.targets.empty() && options.vary.empty()) return SearchPlan{"", std::move(experiment)};
  if (options.targets.empty())
    return InvalidInput("held against what? --targets FILE.toml names the file with the measured values");
  if (options.vary.empty())
    return InvalidInput(
        "what may vary? --vary KEY=LOW..HIGH for each such key ('gauntlet list' has them all)");
  TRY(FitTargets targets, ReadTargetFile(options.targets, experiment));
  for (const std::string& notice : targets.notices) PrintMessage(context, notice);
  FitSpec& spec = experiment.fit;
  TRY(const auto varied, ParseVariedKeys(options.vary, AllKeysOf(experiment), experiment));
  for (const VariedKey& key : varied) {
    const auto sets_it = [&](const std::string& set) { return set.starts_with(key.key.path + "="); };
    if (std::ranges::any_of(options.experiment.sets, sets_it))
      return InvalidInput(
          fmt::format("{} is given by --set and varied by --vary: leave one of them out", key.key.path));
  }
  spec.vary.clear();
  for (const VariedKey& key : varied) spec.vary += (spec.vary.empty() ? "" : " ") + key.ToText();
  spec.targets = std::move(targets.text);
  if (!is_fit) spec.search = experiment.search.algorithm;
  experiment.search.algorithm = "fit";
  experiment.search.replicates = 1;
  TRY(MakeFitPlan(experiment, AllKeysOf(experiment)));
  return SearchPlan{"", std::move(experiment), std::move(targets.cases)};
}

bool IsStudyName(const std::string& name) {
  const std::vector<std::string> shipped = ShippedStudies();
  if (std::ranges::count(shipped, name) > 0) return true;
  return name.ends_with(".toml") && LoadStudy(name).ok();
}

// The same for the same study or experiment with the same settings.
Result<std::uint64_t> IdentityOfPredicted(const FitOptions& options) {
  Fnv1a64 hash;
  for (const std::string& set : options.experiment.sets) hash.AddBytes(set);
  if (IsStudyName(options.predict)) {
    TRY(const Study study, LoadStudy(options.predict));
    for (const auto& [name, text] : study.texts) hash.AddBytes(text);
    return hash.value();
  }
  ExperimentOptions what;
  what.experiment = options.predict;
  what.plugins = options.experiment.plugins;
  TRY(const Experiment experiment, LoadExperimentWith(what, {}));
  hash.AddBytes(WriteExperiment(experiment, {}, BuiltInCatalogue()));
  return hash.value();
}

// Of a study or an experiment, under settings of one draw.
class Predictor {
 public:
  Predictor(CommandContext& context, const FitOptions& options, std::string folder)
      : context_(context),
        options_(options),
        folder_(std::move(folder)),
        is_study_(IsStudyName(options.predict)) {}

  // The figures of draw `number`, whose runs stand in the folder. Nothing when it was stopped.
  Result<std::optional<Figures>> Predict(std::size_t number, const std::vector<std::string>& settings) {
    const std::string directory = fmt::format("{}/draw-{}", folder_, number + 1);
    std::vector<std::string> sets = options_.experiment.sets;
    sets.insert(sets.end(), settings.begin(), settings.end());
    return is_study_ ? PredictStudy(directory, sets) : PredictExperiment(directory, sets);
  }

 private:
  Result<std::optional<Figures>> PredictStudy(const std::string& directory,
                                              const std::vector<std::string>& sets) {
    TRY(const Study study, LoadStudy(options_.predict, {.experiment = "", .repeats = "", .sets = sets}));
    TRY(BeginStudy(directory, study));
    std::ostringstream unread;
    CommandContext quiet{unread,        context_.err,     context_.err_is_terminal,
                         false,         context_.program, context_.campaigns,
                         context_.slurm};
    TRY(const ExitCode code, RunStudyIn(quiet, study, {directory, options_.running, "", nullptr, ""}));
    if (code == kExitStopped) return std::optional<Figures>();
    TRY(const StudyReport report, MakeStudyReport(study, directory));
    Figures figures;
    for (const auto& [name, cell] : report.figures) {
      if (const auto* number = std::get_if<double>(&cell.value)) figures[name] = *number;
    }
    return std::optional(std::move(figures));
  }

  Result<std::optional<Figures>> PredictExperiment(const std::string& directory,
                                                   const std::vector<std::string>& sets) {
    ExperimentOptions what{.experiment = options_.predict,
                           .directory = directory,
                           .seed = "",
                           .sets = sets,
                           .plugins = options_.experiment.plugins};
    TRY(const Experiment experiment, LoadExperimentWith(what, {}));
    CampaignRun campaign;
    campaign.directory = directory;
    campaign.same_command_resumes = true;
    campaign.serving = options_.running;
    TRY(campaign.session.workers, ParseWorkers(options_.running.workers));
    campaign.run = [&](const SessionOptions& session) {
      return CampaignDirectory::IsCampaign(directory)
                 ? context_.campaigns.Resume(directory, session)
                 : context_.campaigns.Start(directory, {{"", experiment}}, session);
    };
    campaign.report = [](const SessionReport&) -> Status { return Ok{}; };
    TRY(const ExitCode code, RunCampaign(context_, campaign));
    if (code == kExitStopped) return std::optional<Figures>();
    TRY(Figures figures, FiguresOfCampaign(directory));
    return std::optional(std::move(figures));
  }

  CommandContext& context_;
  const FitOptions& options_;
  std::string folder_;
  bool is_study_;
};

// Runs what is to be predicted under one draw after the other; those that are there already stay.
Result<ExitCode> Predict(CommandContext& context, const FitOptions& options, const FitResult& fit,
                         const std::string& dir) {
  TRY(const int draws, NumberFrom("--draws", options.draws, 1000, 20));
  if (!fit.finished || fit.draws.empty())
    return InvalidInput(fmt::format(
        "{} {}", dir, fit.finished ? "has no accepted settings to draw from" : "is not finished"));
  TRY(const std::uint64_t identity, IdentityOfPredicted(options));
  const std::string folder =
      fmt::format("{}/predict/{}-{:016x}", dir, fs::path(options.predict).stem().string(), identity);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", folder, error.message())};
  TRY(PredictionFile file, PredictionFile::Open(folder + "/draws.csv"));
  Predictor predictor(context, options, folder);
  const auto all = DrawSettings(fit, static_cast<std::size_t>(draws));
  while (file.size() < all.size()) {
    const std::size_t next = file.size();
    if (!options.running.quiet)
      PrintMessage(context, fmt::format("draw {} of {}: {}", next + 1, draws, fmt::join(all[next], " ")));
    TRY(const std::optional<Figures> figures, predictor.Predict(next, all[next]));
    if (!figures) return kExitStopped;
    TRY(file.Add(all[next], *figures));
  }
  const Table ranges = file.Ranges(all.size());
  if (options.running.json) {
    context.out << JsonText({{"directory", dir}, {"draws", all.size()}, {"figures", ranges.ToJson()}});
  } else {
    context.out << fmt::format(
        "\n{} under {} accepted settings: what they leave open\n{}\n  Every draw: {}\n", options.predict,
        all.size(), ranges.ToText(), folder + "/draws.csv");
  }
  context.out << std::flush;
  return kExitDone;
}

// Prints what is known of the fit, and writes the fitted experiment; of what is predicted, that alone.
Result<ExitCode> Tell(CommandContext& context, const FitOptions& options, const std::string& dir) {
  TRY(const FitResult fit, ReadFit(dir));
  if (!options.output.empty() && fit.fitted && fit.finished) {
    TRY(WriteOutputFile(options.output, FittedToml(fit, dir)));
    PrintMessage(context, fmt::format("wrote {}", options.output));
    for (const std::string& hash : std::set<std::string>{fit.fitted->scenario_plugin, fit.fitted->plugin}) {
      if (!hash.empty())
        PrintMessage(context,
                     fmt::format("it needs {} in plugins/ beside it", PluginFileIn(dir + "/plugins", hash)));
    }
  } else if (!options.output.empty()) {
    PrintMessage(context, fmt::format("{} was not written: no setting is chosen yet", options.output));
  }
  if (!options.predict.empty()) return Predict(context, options, fit, dir);
  if (options.running.json) {
    context.out << FitJson(fit, dir);
  } else {
    for (const Section& section : TellFit(fit, dir, context.program)) context.out << ToText(section);
  }
  context.out << std::flush;
  const bool unwritten = !options.output.empty() && !fit.finished;
  return unwritten || (fit.finished && !fit.Met()) ? kExitNegative : kExitDone;
}

// Of a fit that is there: what was found, or the rest of it.
Result<ExitCode> RunStoredFit(CommandContext& context, const FitOptions& options) {
  const std::string& dir = options.experiment.experiment;
  const bool of_new = !options.targets.empty() || !options.vary.empty() || !options.budget.empty() ||
                      !options.experiment.directory.empty() || !options.experiment.seed.empty() ||
                      (!options.experiment.sets.empty() && options.predict.empty()) ||
                      !options.running.slurm.empty() || options.dry_run || options.print;
  if (of_new)
    return InvalidInput(fmt::format(
        "{} is a campaign: what it fits is decided; only -o, and --predict with --draws and --set, "
        "go with it",
        dir));
  return Tell(context, options, dir);
}

Result<ExitCode> RunFit(CommandContext& context, const FitOptions& options) {
  if (!options.draws.empty() && options.predict.empty())
    return InvalidInput("--draws is for --predict EXPERIMENT or --predict STUDY");
  if (!options.running.slurm.empty() && !options.predict.empty())
    return InvalidInput("--slurm is for the fit itself: --predict simulates on this machine");
  if (CampaignDirectory::IsCampaign(options.experiment.experiment)) return RunStoredFit(context, options);
  TRY(const SearchPlan plan, PlanFit(context, options));
  if (options.print) {
    if (!plan.cases.empty())
      return InvalidInput("--print-experiment: an experiment holds no cases, and a target is about some");
    context.out << WriteExperiment(plan.experiment, {}, BuiltInCatalogue()) << std::flush;
    return kExitDone;
  }
  if (!options.output.empty()) {
    TRY(OutputFile::Open(options.output));  // without it the runs would be for nothing
  }
  return RunAndTell(context, {plan}, options,
                    [&](const std::string& directory) { return Tell(context, options, directory); });
}

}  // namespace

void AddFit(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("fit", "find settings under which the swarm behaves as it was measured", RunFit);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(command, "--targets", "FILE.toml", options.targets,
           "what was measured: tables [[target]] and [[require]]");
  AddValue(command, "--vary", "KEY=RANGE", options.vary,
           "a key that may vary: KEY=LOW..HIGH, KEY=LOW..HIGH:log or KEY=A|B; repeatable");
  AddValue(command, "--budget", "RUNS", options.budget,
           "runs over all settings; the judgement of the chosen one comes on top (default: 20000)");
  AddValue(command, "-o,--output", "FITTED.toml", options.output,
           "write the experiment with the chosen setting");
  AddValue(command, "--predict", "WHAT", options.predict,
           "an experiment or a study: what the accepted settings leave open of its figures");
  AddValue(command, "--draws", "N", options.draws, "accepted settings that it runs under (default: 20)");
  command.add_flag("--print-experiment", options.print,
                   "print the experiment of the fit instead, for 'gauntlet submit'");
  command.footer(
      R"(Simulates different settings, learns how the measured quantities follow from them, and keeps the settings that are
likely, given what was measured (a synthetic likelihood over Gaussian-process emulators, in four rounds). The chosen
setting is the likeliest, rounded to two digits that count; it is judged on fresh cases. Exit 1 when it misses a
target. In place of EXPERIMENT stands the directory of a fit to tell it again, or its experiment.

The file of targets (docs/fit.md explains it):
  [[target]]                      # value, or at_most, or at_least
  metric = "fitness"              # of the scenario; statistic: mean, sd, median, quantile:0.9
  value = 20.5
  n = 100                         # runs that were measured
  [[target]]
  csv = "measured.csv"            # the whole distribution of a column
  column = "transfers"
  [[require]]                     # every one of 100 runs without obstacles
  formula = "food_carried <= 6"
  runs = 100

Examples:
  gauntlet fit task-partitioning --targets lab.toml --vary controller_parameters.wait_time=5..300:log -o lab-fitted.toml
  gauntlet fit my.toml --targets lab.toml --vary physics=impulse|box2d --vary scenario_parameters.robots=4..8 --budget 5000
  gauntlet fit campaigns/my-fit --predict flocking --draws 50 --set search.generations=20
  gauntlet fit my.toml --targets lab.toml --vary scenario_parameters.robots=4..8 --print-experiment > fit.toml)");
}

}  // namespace gauntlet
