// gauntlet check: do the cases of a corpus still break the controller?
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/hash.h"
#include "base/system/atomic_file.h"
#include "cli/commands.h"
#include "cli/corpus_experiment.h"
#include "cli/given_cases.h"
#include "cli/output/check_report.h"
#include "cli/output/output_file.h"
#include "cli/run_campaign.h"
#include "master/campaign/stored_search.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/plugins.h"
#include "search/given/confirmation_search.h"
#include "study/questions/answered_calls.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "/.check";  // of a corpus: the runs of its checks

struct CheckOptions : RunningOptions {
  std::string corpus;
  std::vector<std::string> sets;
  std::vector<std::string> plugins;
  std::string junit;
  bool update = false;
};

// The cases of a corpus as searches: one for each different experiment.
struct CorpusPlan {
  std::vector<CorpusEntry> entries;
  std::vector<Experiment> experiments;  // of each entry
  std::vector<SearchPlan> searches;
  std::vector<std::vector<std::size_t>> entry_of;  // [search][case]
  std::string directory;
};

Result<CorpusPlan> PlanCheck(const CheckOptions& options) {
  TRY(std::vector<CorpusEntry> entries, ReadCorpus(options.corpus));
  TRY(const std::vector<std::string> plugins, AddPluginFiles(options.plugins));
  CorpusPlan plan{std::move(entries), {}, {}, {}, ""};
  std::map<std::vector<std::pair<std::string, std::string>>, std::size_t> search_of;
  Fnv1a64 hash;
  for (std::size_t i = 0; i < plan.entries.size(); ++i) {
    TRY(const Experiment experiment, ExperimentOf(plan.entries[i], options.sets, plugins));
    plan.experiments.push_back(experiment);
    const auto [search, is_new] = search_of.try_emplace(SettingsOf(experiment), plan.searches.size());
    if (is_new) {
      plan.searches.push_back(
          {fmt::format("settings of {}", plan.entries[i].content.name), CheckOf(experiment)});
      plan.entry_of.emplace_back();
    }
    sim::TestCase test_case = plan.entries[i].content.document.test_case;
    test_case.name = plan.entries[i].content.name;
    hash.AddUint64(KeyOfCase(CheckOf(experiment), test_case));
    plan.searches[search->second].cases.push_back(std::move(test_case));
    plan.entry_of[search->second].push_back(i);
  }
  if (plan.searches.size() == 1) plan.searches.front().settings.clear();
  plan.directory = fmt::format("{}{}/{:016x}", options.corpus, kFolder, hash.value());
  return plan;
}

// A check that has ended is done anew: the controller's code may have changed since. One that was stopped is
// gone on with.
Status MakeRoom(CommandContext& context, const CorpusPlan& plan) {
  if (!CampaignDirectory::IsCampaign(plan.directory)) return Ok{};
  TRY(const CampaignSummary earlier, context.campaigns.Read(plan.directory));
  if (!earlier.finished) return Ok{};
  TRY(const bool lives, context.campaigns.MasterLives(plan.directory));
  if (lives) return Ok{};
  std::error_code error;
  fs::remove_all(plan.directory, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", plan.directory, error.message())};
  return Ok{};
}

// Whoever keeps the corpus under version control does not mean the runs.
Status MakeFolder(const CheckOptions& options) {
  const std::string folder = options.corpus + kFolder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", folder, error.message())};
  if (fs::exists(folder + "/.gitignore", error)) return Ok{};
  return ReplaceFile(folder + "/.gitignore", "*\n", kReadableByAll);
}

Result<CorpusReport> ReadReport(CommandContext& context, const CheckOptions& options,
                                const CorpusPlan& plan) {
  CorpusReport report{options.corpus,
                      plan.experiments.front().scenario,
                      plan.experiments.front().controller,
                      plan.directory,
                      {}};
  for (const CorpusEntry& entry : plan.entries)
    report.cases.push_back({.name = entry.content.name,
                            .file = entry.file,
                            .expected = entry.content.expected,
                            .tally = {},
                            .interval = {0.0, 1.0},
                            .message = {}});
  const std::string_view failing = FailingOf(plan.experiments.front());
  TRY(context.campaigns.ForEachRun(plan.directory, [&](const StoredRun& run) -> Status {
    const Result<RunOutcome> outcome = OutcomeOf(run, FailingNeedsMetrics(failing));
    const bool known = run.search >= 1 && run.search <= plan.entry_of.size() && run.individual >= 1 &&
                       run.individual <= plan.entry_of[run.search - 1].size();
    if (!outcome || !known)
      return Error{ErrorKind::kCorrupt,
                   fmt::format("run {} of {} does not read back", run.id, plan.directory)};
    CheckedCase& one =
        report.cases[plan.entry_of[run.search - 1][static_cast<std::size_t>(run.individual) - 1]];
    const int passes = one.tally.passes;
    one.tally.Add(*outcome, failing);
    if (one.tally.passes == passes && one.run == 0) one.run = run.id;
    if (one.message.empty()) one.message = run.message;
    return Ok{};
  }));
  for (CheckedCase& one : report.cases) {
    one.verdict = VerdictOf(one.tally, 0);
    one.interval = FailureInterval(one.tally);
  }
  return report;
}

// Lines of a diff between what a file says and what it is to say.
std::string DiffOf(const CorpusCase& before, const CorpusCase& after) {
  std::string diff;
  const auto compare = [&](const std::string& key, const std::string& was, const std::string& is) {
    if (was == is) return;
    if (!was.empty()) diff += fmt::format("-{}: {}\n", key, was);
    if (!is.empty()) diff += fmt::format("+{}: {}\n", key, is);
  };
  compare("expected", before.expected, after.expected);
  for (const auto& [key, value] : before.settings) compare("experiment." + key, value, SettingOf(after, key));
  for (const auto& [key, value] : after.settings) {
    if (SettingOf(before, key).empty()) compare("experiment." + key, "", value);
  }
  return diff;
}

// Writes what was seen, and with which settings, into the files; prints what changes.
Status Update(CommandContext& context, const CheckOptions& options, const CorpusPlan& plan,
              const CorpusReport& report) {
  int changed = 0;
  std::string diffs;
  for (std::size_t i = 0; i < plan.entries.size(); ++i) {
    if (report.cases[i].verdict == FailureVerdict::kError) continue;
    const CorpusEntry& entry = plan.entries[i];
    CorpusCase after = entry.content;
    after.expected = NameOf(report.cases[i].verdict);
    if (!options.sets.empty()) after.settings = SettingsOf(plan.experiments[i]);
    const std::string diff = DiffOf(entry.content, after);
    if (diff.empty()) continue;
    ++changed;
    diffs += fmt::format("--- {0}\n+++ {0}\n{1}", entry.file, diff);
    TRY(WriteOutputFile(entry.file, WriteCorpusCase(after)));
  }
  if (!options.json) context.out << "\n" << diffs << std::flush;
  PrintMessage(context, fmt::format("{} of {} files changed", changed, plan.entries.size()));
  return Ok{};
}

Result<ExitCode> RunCheck(CommandContext& context, const CheckOptions& options) {
  TRY(const int workers, ParseWorkers(options.workers));
  TRY(const CorpusPlan plan, PlanCheck(options));
  std::optional<OutputFile> junit;  // opened before the runs, which would be for nothing without it
  if (!options.junit.empty()) {
    TRY(OutputFile opened, OutputFile::Open(options.junit));
    junit.emplace(std::move(opened));
  }
  TRY(MakeRoom(context, plan));
  TRY(MakeFolder(options));

  bool worse = false;
  CampaignRun campaign = RunOfCall(context, {plan.directory, plan.searches}, workers, options);
  campaign.report = [&](const SessionReport& session) -> Status {
    if (session.end == CampaignEnd::kStopped) return Ok{};
    TRY(const CorpusReport report, ReadReport(context, options, plan));
    worse = report.Count(CheckOutcome::kWorse) > 0;
    context.out << (options.json ? CheckJson(report) : CheckText(report, context.program)) << std::flush;
    if (junit) {
      TRY(junit->Write(CheckJunit(report)));
      TRY(junit->Close());
    }
    if (!options.update) return Ok{};
    worse = std::ranges::count(report.cases, FailureVerdict::kError, &CheckedCase::verdict) > 0;
    return Update(context, options, plan, report);
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  return code == kExitDone && worse ? kExitNegative : code;
}

}  // namespace

void AddCheck(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("check", "do the cases of a corpus still break the controller?", RunCheck);
  command.add_option("CORPUS", options.corpus, "folder of cases, made by 'gauntlet corpus add'")->required();
  AddValue(command, "--set", "KEY=VALUE", options.sets,
           "check with this setting instead of the files': controller=..., controller_parameters.NAME=...");
  AddPluginOption(command, options.plugins);
  AddValue(command, "--junit", "F", options.junit, "write the outcome as JUnit's XML");
  command.add_flag("--update", options.update,
                   "expect from now on what was seen, with the settings of --set; prints what changes");
  AddRunningOptions(command, options);
  command.footer(
      R"(The regression suite of a controller. Every case is simulated with fresh seeds until it has failed 5 times
or not failed 6 times (at most 10 runs). What comes of it, fail (in at least half of the runs), flaky (in
fewer) or pass (in none), is held against what the case's file expects; exit 1 when a case is worse than
expected or a run ended without a result. The same controller gets the same seeds, so the outcome changes only
with the controller. A case that was added is expected to fail until it is mended: then --update writes "pass"
into its file, and the case that fails again is found.

A check that was stopped or killed goes on with the same command; the runs are in CORPUS/.check.

Examples:
  gauntlet check corpus
  gauntlet check corpus --set controller=flocking-improved
  gauntlet check corpus --set controller=flocking-improved --update
  gauntlet check corpus --junit check.xml --json)");
}

}  // namespace gauntlet
