// gauntlet corpus add: keep cases that break a controller, for `gauntlet check`.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "analysis/figures/run/run_figure.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "proto/run_text.h"
#include "report/figures/replayed_figure.h"
#include "search/cases/case_file.h"
#include "search/experiment/experiment_file.h"
#include "search/search_setup.h"
#include "study/questions/confirmations.h"
#include "study/questions/corpus_experiment.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPictureBytes = 64U << 20;  // of a picture

struct CorpusOptions {
  std::string action;
  std::string directory;
  std::vector<std::string> cases;
  std::string corpus;
  std::string name;
};

// A case that is to be kept.
struct Keepsake {
  CorpusCase content;
  std::string picture;               // SVG
  std::vector<std::string> plugins;  // those that bring scenario and controller, by their SHA-256
};

// By their SHA-256, each once; none where all is built in.
std::vector<std::string> PluginsOf(const Experiment& experiment) {
  std::set<std::string> hashes = {experiment.plugin, experiment.scenario_plugin};
  hashes.erase("");
  return {hashes.begin(), hashes.end()};
}

// The picture that `minimise` has drawn beside a case's file.
Result<std::string> PictureBeside(const std::string& file) {
  return ReadSmallFile(fs::path(file).replace_extension(".svg").string(), kMostPictureBytes);
}

Status CheckFails(const std::string& what, const proto::CaseFailures& found) {
  if (found.runs > 0 && 2 * found.failures >= found.runs) return Ok{};
  return InvalidInput(
      fmt::format("{} failed in {} of {} runs with fresh seeds: a corpus keeps what fails in at "
                  "least half",
                  what, found.failures, found.runs));
}

// A case that was made out of another one, or any other file.
Result<Keepsake> KeepsakeOfFile(const CorpusOptions& options, const std::string& file,
                                const Experiment& experiment) {
  TRY(LoadedCase loaded, LoadCase(file));
  if (!loaded.lineage) {
    return InvalidInput(
        fmt::format("{}: nothing in it says how often it fails. Name the run that it comes from, or a file "
                    "that `gauntlet "
                    "minimise` has made",
                    file));
  }
  Keepsake kept;
  kept.content.found = loaded.lineage->verified;
  TRY(CheckFails(file, kept.content.found));
  kept.content.found_in =
      fmt::format("{} of {}, by {}", loaded.lineage->parent.name, experiment.name, loaded.lineage->made_by);
  kept.content.settings = SettingsOf(experiment);
  kept.plugins = PluginsOf(experiment);
  kept.content.document = {std::move(loaded.test_case), std::move(loaded.lineage)};
  TRY(kept.picture, PictureBeside(file));
  kept.content.name = options.name.empty() ? fs::path(file).stem().string() : options.name;
  return kept;
}

// What is left of the run's case, whose clone may have been minimised as another run's.
std::vector<SmallestLayout>::const_iterator LeftOf(const std::vector<SmallestLayout>& layouts,
                                                   const QuestionedCampaign& questioned, RunId run) {
  const auto own = std::ranges::find(layouts, run, &SmallestLayout::run);
  if (own != layouts.end() || questioned.plans.size() > 1) return own;  // clones in other searches are others
  const std::uint64_t test_case = CaseHash(questioned.cases.front().test_case);
  return std::ranges::find_if(layouts, [test_case](const SmallestLayout& one) {
    return CaseHash(one.document.lineage->parent) == test_case;
  });
}

Result<Keepsake> KeepsakeOfRun(CommandContext& context, const CorpusOptions& options, RunId run) {
  TRY(QuestionedCampaign questioned, CasesOfRuns(options.directory, {run}));
  CaseInQuestion& one = questioned.cases.front();
  const Experiment& experiment = questioned.plans[one.search].experiment;
  TRY(const std::vector<SmallestLayout> smallest, ReadSmallestLayouts(options.directory));
  if (const auto left = LeftOf(smallest, questioned, run); left != smallest.end()) {
    Result<Keepsake> kept = KeepsakeOfFile(options, left->file, experiment);
    if (kept && options.name.empty()) kept->content.name = fmt::format("run-{}", run);
    return kept;
  }

  TRY(const std::vector<Confirmation> known, ReadConfirmations(options.directory));
  const auto confirmed =
      std::ranges::find(known, ConfirmationKey(experiment, one.test_case), &Confirmation::key);
  if (confirmed == known.end()) {
    return InvalidInput(fmt::format(
        "run {} was not simulated again with fresh seeds: `{} confirm {} {}` does it", proto::RunText(run),
        context.program, PastedPath(options.directory), proto::RunText(run)));
  }
  Keepsake kept;
  kept.content.found = {confirmed->tally.failures,
                        confirmed->tally.runs(),
                        {confirmed->interval.low, confirmed->interval.high}};
  TRY(CheckFails(fmt::format("run {}", proto::RunText(run)), kept.content.found));
  TRY(const CampaignReplay replay,
      context.campaigns.Replay(confirmed->campaign, confirmed->Typical()->id, /*scratch=*/""));
  kept.picture = analysis::DrawRun(FigureOf(experiment.name, replay.report));
  kept.content.found_in = fmt::format("run {} of {}", proto::RunText(run), experiment.name);
  kept.content.settings = SettingsOf(experiment);
  kept.plugins = PluginsOf(experiment);
  kept.content.document = {std::move(one.test_case)};
  kept.content.name = options.name.empty() ? fmt::format("run-{}", run) : options.name;
  return kept;
}

Result<Keepsake> KeepsakeOf(CommandContext& context, const CorpusOptions& options, const std::string& text) {
  if (std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; })) {
    TRY(const std::uint64_t run, ParseRunId(text));
    return KeepsakeOfRun(context, options, run);
  }
  TRY(const QuestionedCampaign questioned, CasesOfRuns(options.directory, {}));
  TRY(CheckTakesFiles(questioned, options.directory, text));
  return KeepsakeOfFile(options, text, questioned.plans.front().experiment);
}

// What is there already, and what is to come, must make one corpus.
Status CheckFits(const CorpusOptions& options, const std::vector<Keepsake>& kept) {
  std::vector<CorpusEntry> all;
  std::error_code none;
  if (fs::exists(options.corpus, none) && !fs::is_empty(options.corpus, none)) {
    TRY(all, ReadCorpus(options.corpus));
  }
  for (const Keepsake& one : kept) {
    const std::string& name = one.content.name;
    if (std::ranges::any_of(all, [&](const CorpusEntry& other) { return other.content.name == name; })) {
      return InvalidInput(fmt::format("{} has a case called '{}' already: give this one another --name",
                                      options.corpus, name));
    }
    for (const char* ending : {".json", ".svg"}) {
      const std::string file = fmt::format("{}/{}{}", options.corpus, name, ending);
      if (fs::exists(file, none))
        return InvalidInput(fmt::format("{} exists already: give this case another --name", file));
    }
    for (const char* key : {"scenario", "controller"}) {
      const std::string here = all.empty() ? "" : SettingOf(all.front().content, key);
      const std::string its = SettingOf(one.content, key);
      if (!all.empty() && here != its) {
        return InvalidInput(fmt::format("{} holds cases of the {} '{}', '{}' is of '{}': --to another folder",
                                        options.corpus, key, here, name, its));
      }
    }
    all.push_back({fmt::format("{}/{}.json", options.corpus, name), one.content});
    TRY(ParseCorpusCase(WriteCorpusCase(one.content), "--name " + name));
    TRY(ExperimentOf(all.back(), {}, one.plugins));
  }
  return Ok{};
}

Result<ExitCode> RunCorpus(CommandContext& context, const CorpusOptions& options) {
  if (options.action != "add") {
    return InvalidInput(fmt::format("corpus {}: 'corpus add' is what there is", options.action));
  }
  if (!options.name.empty() && options.cases.size() > 1)
    return InvalidInput(
        fmt::format("--name {}: {} cases cannot have one name", options.name, options.cases.size()));
  std::vector<Keepsake> kept;
  for (auto text = options.cases.begin(); text != options.cases.end(); ++text) {
    if (std::find(options.cases.begin(), text, *text) != text) continue;  // given twice
    TRY(Keepsake one, KeepsakeOf(context, options, *text));
    kept.push_back(std::move(one));
  }
  TRY(CheckFits(options, kept));
  TRY(const std::vector<Baseline> baselines, ReadBaselines(options.directory));
  if (Matters(baselines)) PrintMessage(context, InWords(baselines, context.program, options.directory));
  std::error_code error;
  fs::create_directories(options.corpus, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", options.corpus, error.message())};
  for (const Keepsake& one : kept) {
    const std::string path = fmt::format("{}/{}", options.corpus, one.content.name);
    TRY(WriteOwnFile(path + ".svg", one.picture));
    TRY(WriteOwnFile(path + ".json", WriteCorpusCase(one.content)));
    context.out << fmt::format("{}.json  {} obstacles, failed in {} of {} fresh runs ({}); picture {}.svg\n",
                               path, one.content.document.test_case.obstacles.size(),
                               one.content.found.failures, one.content.found.runs, one.content.found_in,
                               path);
  }
  std::set<std::string> plugins;
  for (const Keepsake& one : kept) plugins.insert(one.plugins.begin(), one.plugins.end());
  std::string named;  // the campaign's own copies
  for (const std::string& hash : plugins)
    named += " --plugin " + PastedPath(PluginFileIn(options.directory + "/plugins", hash));
  context.out << fmt::format("\nDoes the controller still fail? {} check {}{}\n", context.program,
                             PastedPath(options.corpus), named)
              << std::flush;
  return kExitDone;
}

}  // namespace

void AddCorpus(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("corpus", "keep cases that break a controller for 'check' ('corpus add')", RunCorpus);
  command.add_option("ACTION", options.action, "the word add")->required();
  AddDirectory(command, options.directory);
  command
      .add_option("CASE", options.cases,
                  "runs of the campaign whose cases are kept, or case files that 'minimise' wrote")
      ->required();
  AddValue(command, "--to", "CORPUS", options.corpus,
           "the folder of the cases; it is made if it does not exist")
      ->required();
  AddValue(command, "--name", "NAME", options.name, "name of the case and of its files (default: run-N)");
  command.footer(
      R"(Writes each case as one readable file, CORPUS/NAME.json, and its picture, CORPUS/NAME.svg. The file holds the
layout, the controller and all settings, how often the case failed with fresh seeds, and the verdict that
'gauntlet check' expects: "fail", until the controller is repaired. If 'gauntlet minimise' has made the case
smaller, the smaller case is kept. Only confirmed cases are accepted: give 'gauntlet confirm DIR RUN_ID' or
'gauntlet minimise DIR RUN_ID' first. Keep the folder under version control, beside the controller.

Examples:
  gauntlet corpus add DIR 812 --to corpus
  gauntlet corpus add DIR 812 817 --to corpus
  gauntlet corpus add DIR my-minimised.json --to corpus --name jam-at-the-corner)");
}

}  // namespace gauntlet
