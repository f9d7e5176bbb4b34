// gauntlet tune: which values of a search's parameters are worth having, and how many repeats are enough.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/study_run.h"
#include "master/directory/plugins.h"

namespace gauntlet {
namespace {

struct TuneOptions {
  std::string experiment;
  std::string candidates;
  std::string repeats;
  std::vector<std::string> sets;
  std::vector<std::string> tries;
  std::string budget;
  StudyStartOptions start;
};

constexpr const char* kCandidates = "tune-flocking";  // of experiments without a list of their own

bool IsTuning(const Study& study) {
  return std::ranges::any_of(study.analyses, [](const StudyAnalysis& one) { return one.tuning.has_value(); });
}

Result<Study> LoadTuning(const TuneOptions& options) {
  TRY(const std::vector<std::string> plugins, AddPluginFiles(options.start.plugins));
  const std::vector<std::string> shipped = ShippedStudies();
  const std::string own = "tune-" + options.experiment;
  if (options.candidates.empty() && std::ranges::count(shipped, own) > 0)
    return LoadStudy(own, {"", options.repeats, options.sets, options.tries, options.budget}, plugins);
  std::string experiment = options.experiment;
  // A file is found again by whoever goes on, from wherever that is.
  std::error_code error;
  const bool is_file = experiment.find('/') != std::string::npos || experiment.ends_with(".toml");
  if (is_file) experiment = std::filesystem::absolute(experiment, error).string();
  Result<Study> study =
      LoadStudy(options.candidates.empty() ? kCandidates : options.candidates,
                {experiment, options.repeats, options.sets, options.tries, options.budget}, plugins);
  if (study && !IsTuning(*study)) {
    return InvalidInput(fmt::format("--candidates {}: the study has no table [tune.NAME] with candidates",
                                    options.candidates));
  }
  return study;
}

Result<ExitCode> RunTune(CommandContext& context, const TuneOptions& options) {
  TRY(const Study study, LoadTuning(options));
  return StartStudy(context, study, options.start);
}

}  // namespace

void AddTune(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("tune", "test which values of a search's parameters find tougher cases", RunTune);
  command.add_option("EXPERIMENT", options.experiment, "the baseline: a shipped experiment or a TOML file")
      ->required();
  AddValue(command, "--candidates", "STUDY", options.candidates,
           "the values to try: a shipped study or a TOML file with a table [tune.NAME] (default: "
           "tune-EXPERIMENT if there is one, else tune-flocking)");
  AddValue(command, "--try", "KEY=A,B,C", options.tries,
           "values of one key to try, instead of the study's; repeatable");
  AddValue(
      command, "--budget", "RUNS", options.budget,
      "give each evolution as many generations as so many runs pay for, so that values which cost more a "
      "generation are compared at equal cost (default: equal generations)");
  AddValue(
      command, "--repeats", "N", options.repeats,
      "number of evolutions for each value, 1 to 100 (default: that of the study, 20 in the shipped ones)");
  AddValue(command, "--set", "KEY=VALUE", options.sets,
           "change a value of the baseline, as for 'evolve'; repeatable");
  AddStudyStartOptions(command, options.start);
  command.footer(
      R"(Changes one parameter at a time, keeps the experiment's values of all others, and compares each value with the
baseline by Vargha and Delaney's A (the robustness analysis of Spartan). Each evolution gives one figure, the mean
fitness of its final population, simulated again with fresh seeds. A value is recommended in place of the
baseline's when A is large (0.71) and the difference is significant (p below 0.05 after Holm's correction). A
consistency analysis shows how many repeats are enough: it draws sets of evolutions with the same parameters and
measures how much A differs from 0.5 between them.

The shipped candidates are those of Tables 4.1 and 5.1 of H. Wei's thesis (studies tune-flocking, tune-foraging).
A tuning is a study: its evolutions share the workers, and it continues with the same command or with 'gauntlet
resume DIR' after it was stopped or killed. It writes robustness.svg and consistency.svg to its directory.
'gauntlet report DIR -o tuning.html' shows it in a browser.

Examples:
  gauntlet tune flocking --dry-run
  gauntlet tune flocking --repeats 5 --dir campaigns/tuning
  gauntlet tune flocking --try search.population=10,20,50 --budget 1000 --repeats 5 --dir campaigns/population
  gauntlet tune my-experiment.toml --candidates my-candidates.toml --markdown tuning.md)");
}

}  // namespace gauntlet
