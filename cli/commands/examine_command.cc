// gauntlet examine: from a controller to an answer, by the other commands.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/options/stop_signal.h"
#include "cli/output/examination_output.h"
#include "cli/output/output_file.h"
#include "cli/run_campaign.h"
#include "master/campaign/forecast.h"
#include "master/directory/campaign_directory.h"
#include "proto/json_text.h"
#include "report/pages/report_page.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/examination_plan.h"
#include "study/questions/distinct_failures.h"
#include "study/questions/empty_arena.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using Command = std::vector<std::string>;

constexpr std::size_t kExaminedRuns = 30;  // that the page shows

struct ExamineOptions : LocalOptions {
  std::string budget;
  std::string out;
};

// The same commands as somebody would type, one after the other. What is there already is gone on with.
class Examination {
 public:
  Examination(CommandContext& context, const ExamineOptions& options, const Experiment& experiment,
              std::string directory, ExaminationPlan plan)
      : context_(context),
        options_(options),
        experiment_(experiment),
        directory_(std::move(directory)),
        plan_(std::move(plan)) {}

  // The first ones; which follow depends on what these find.
  std::vector<Command> Searches() const {
    std::vector<Command> commands = {
        New("random", "/random", {"--cases", fmt::format("{}", plan_.random_cases)}),
        {"baseline", directory_ + "/random"},
        New("evolve", "/search",
            {"--set", "search.algorithm=" + plan_.algorithm, "--set", plan_.search_length}),
        {"baseline", directory_ + "/search"},
        {"confirm", directory_ + "/search", "--elites", "--replicates", fmt::format("{}", plan_.replicates)}};
    return commands;
  }
  std::vector<Command> Margins() const {
    if (plan_.vary.empty()) return {};
    std::vector<std::string> more = {"--budget", fmt::format("{}", plan_.margin_runs)};
    for (const std::string& key : plan_.vary) more.insert(more.end(), {"--vary", key});
    return {New("margin", "/margins", more)};
  }

  int steps() const { return steps_; }
  // Exit 0 when the whole examination is there.
  Result<ExitCode> Run() {
    for (const Command& command : Searches()) {
      if (command.front() == "evolve" && FailsAnyway()) return kExitDone;
      if (command.front() == "confirm" && !FoundSomething()) continue;
      TRY(const ExitCode code, Step(command));
      if (code != kExitDone) return code;
    }
    TRY(const std::vector<RunId> runs, ToughestRuns());
    for (const RunId run : runs) {
      for (const char* question : {"minimise", "blame"}) {
        TRY(const ExitCode code, Step({question, directory_ + "/search", fmt::format("{}", run)}));
        if (code != kExitDone && code != kExitNegative) return code;
      }
    }
    for (const Command& command : Margins()) {
      TRY(const ExitCode code, Step(command));
      if (code != kExitDone) return code;
    }
    return kExitDone;
  }

 private:
  Command New(const std::string& name, const std::string& folder,
              const std::vector<std::string>& more) const {
    Command command = {name, options_.experiment.experiment};
    const auto add = [&](const char* option, const std::vector<std::string>& values) {
      for (const std::string& value : values) command.insert(command.end(), {option, value});
    };
    add("--set", options_.experiment.sets);
    add("--plugin", options_.experiment.plugins);
    add("--allow-file", options_.experiment.allowed_files);
    if (!options_.experiment.seed.empty()) add("--seed", {options_.experiment.seed});
    command.insert(command.end(), more.begin(), more.end());
    add("--dir", {directory_ + folder});
    return command;
  }

  // What it prints is told at the end; how it goes on is shown meanwhile.
  Result<ExitCode> Step(const Command& command) {
    Command whole = command;
    const auto dir = std::ranges::find(whole, "--dir");
    if (dir != whole.end() && CampaignDirectory::IsCampaign(*(dir + 1))) whole = {"resume", *(dir + 1)};
    for (const std::string& setting : options_.running.slurm) whole.insert(whole.end(), {"--slurm", setting});
    if (!options_.running.workers.empty()) whole.insert(whole.end(), {"--workers", options_.running.workers});
    if (!options_.running.audit.empty()) whole.insert(whole.end(), {"--audit", options_.running.audit});
    if (!options_.running.metrics_port.empty())
      whole.insert(whole.end(), {"--metrics-port", options_.running.metrics_port});
    if (options_.running.quiet) whole.push_back("--quiet");
    if (options_.running.no_progress) whole.push_back("--no-progress");
    if (!options_.running.quiet)
      PrintMessage(context_, fmt::format("step {}: {}", ++steps_, fmt::join(Quoted(command), " ")));
    std::ostringstream told;
    CommandContext inner{.out = told,
                         .err = context_.err,
                         .err_is_terminal = context_.err_is_terminal,
                         .out_is_terminal = false,
                         .program = context_.program,
                         .campaigns = context_.campaigns,
                         .slurm = context_.slurm};
    const ExitCode code = RunCommandLine(whole, inner);
    // The look at the empty arena stops nothing but itself.
    return code == kExitDone && StopSignal::Requested() ? kExitStopped : code;
  }

  static Command Quoted(const Command& command) {
    Command quoted;
    for (const std::string& one : command) quoted.push_back(ShellQuoted(one));
    return quoted;
  }

  // Then no layout is to blame, and there is nothing to search for: the first runs say so as `evolve` would.
  bool FailsAnyway() const {
    const auto tally = FirstEmptyRuns(experiment_, /*all=*/false);
    return tally && !CheckEmptyArena(experiment_, *tally);
  }

  // Cases that the search has ended with.
  bool FoundSomething() const {
    const auto found = PopulationCases(directory_ + "/search");
    return !found || !found->cases.empty();
  }

  // The toughest case of each distinct failure, those by mechanism first; then the toughest others.
  Result<std::vector<RunId>> ToughestRuns() const {
    TRY(const auto confirmations, ExaminedCases(directory_ + "/search"));
    const DistinctFailures distinct = DistinctFailuresOf(confirmations, {});
    std::vector<const Confirmation*> wanted;
    for (const DistinctFailure* failure : distinct.All()) wanted.push_back(failure->cases.front());
    const std::size_t groups = wanted.size();
    for (const Confirmation& one : confirmations) wanted.push_back(&one);
    std::ranges::stable_sort(wanted.begin() + static_cast<std::ptrdiff_t>(groups), wanted.end(),
                             std::greater(), [](const Confirmation* one) { return Toughness(*one); });
    std::vector<RunId> runs;
    for (const Confirmation* one : wanted) {
      if (one->verdict == FailureVerdict::kFail && runs.size() < plan_.minimised &&
          std::ranges::count(runs, one->run) == 0)
        runs.push_back(one->run);
    }
    return runs;
  }

  CommandContext& context_;
  const ExamineOptions& options_;
  const Experiment& experiment_;
  const std::string directory_;
  const ExaminationPlan plan_;
  int steps_ = 0;
};

Result<std::uint64_t> BudgetOf(const std::string& text) {
  if (text.empty()) return std::uint64_t{0};
  const auto runs = ParseNumber<std::uint64_t>(text);
  if (runs && *runs > 0) return *runs;
  return InvalidInput(fmt::format("--budget {}: give a number of runs, such as {}", Printable(text),
                                  ExaminationPlan::kDefaultRuns));
}

// It chooses its searches itself, and the same command must mean the same.
Status CheckOptions(const ExamineOptions& options) {
  for (const std::string& set : options.experiment.sets) {
    if (set.starts_with("search.") && !set.starts_with("search.cells"))
      return InvalidInput(
          fmt::format("--set {}: examine chooses its searches itself; --budget says how long they "
                      "are",
                      set));
  }
  if (options.experiment.seed == "random")
    return InvalidInput("--seed random: the same command could not go on; give a number");
  if (options.out.empty() && !options.dry_run) return InvalidInput("where to? -o FILE.html names the page");
  return Ok{};
}

// An examination of something else does not go on where this one is kept.
Status Claim(const std::string& directory, const std::string& what) {
  const std::string path = directory + "/examination.toml";
  std::error_code error;
  if (fs::exists(path, error)) {
    TRY(const std::string there, ReadRegularFile(path));
    if (there == what) return Ok{};
    return InvalidInput(
        fmt::format("{0} holds an examination with another experiment, seed or budget, as "
                    "{0}/examination.toml says: give another --dir",
                    directory));
  }
  if (fs::exists(directory, error) && !fs::is_empty(directory, error))
    return InvalidInput(fmt::format("{} holds something else: --dir names a new directory", directory));
  fs::create_directories(directory, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", directory, error.message())};
  return ReplaceFile(path, what, kReadableByAll);
}

Result<ExitCode> PrintPlan(CommandContext& context, const ExamineOptions& options,
                           const Experiment& experiment, const ExaminationPlan& plan,
                           const Examination& examination, int workers) {
  Experiment search = experiment;
  search.search.algorithm = "random";
  TRY(const Forecast forecast, MakeForecast({{"", search, {}}}));
  const double seconds = forecast.seconds_per_run * static_cast<double>(plan.runs) / workers;
  std::vector<Command> commands = examination.Searches();
  for (const Command& one : examination.Margins()) commands.push_back(one);
  if (options.running.json) {
    context.out << JsonText({{"runs", plan.runs},
                             {"workers", workers},
                             {"seconds", seconds},
                             {"cpu_seconds_per_run", forecast.seconds_per_run},
                             {"commands", commands},
                             {"not_varied", plan.unvaried}})
                << std::flush;
    return kExitDone;
  }
  Section section{.title = fmt::format("{}: a dry run, nothing was made", experiment.name)};
  section.lead = {
      fmt::format("At most about {} runs, {} with {} ({} of the first runs took {:.3g} ms each here).",
                  FormatCount(plan.runs), FormatDuration(seconds), Counted(workers, "worker"),
                  forecast.measured_runs, 1e3 * forecast.seconds_per_run)};
  for (const Command& one : commands) {
    std::string line = context.program;
    for (const std::string& word : one) line += " " + ShellQuoted(word);
    section.commands.push_back({line, ""});
  }
  context.out << ToText(section) << std::flush;
  return kExitDone;
}

Status WritePage(const ExaminationFacts& facts, const std::string& directory, const std::string& path) {
  TRY(Report report, GatherReport({facts.search.directory}, kExaminedRuns));
  for (const char* folder : {"/margins", "/random"}) {
    const std::string campaign = directory + folder;
    if (!CampaignDirectory::IsCampaign(campaign) || campaign == facts.search.directory) continue;
    TRY(CampaignPages pages, GatherPages(campaign, 0));
    report.campaigns.push_back(std::move(pages));
  }
  return WriteOutputFile(path, ReportPage(report));
}

Result<ExitCode> RunExamine(CommandContext& context, const ExamineOptions& options) {
  TRY(const std::uint64_t budget, BudgetOf(options.budget));
  TRY(CheckOptions(options));
  TRY(const Experiment as_given, LoadExperimentWith(options.experiment, {}));
  TRY(const ExaminationPlan plan, PlanExamination(as_given, budget));
  TRY(const Experiment experiment,
      LoadExperimentWith(options.experiment, {{"examine", "search.algorithm", plan.algorithm}}));
  const std::string directory = options.experiment.directory.empty()
                                    ? fmt::format("campaigns/{}-examined", experiment.name)
                                    : options.experiment.directory;
  Examination examination(context, options, experiment, directory, plan);
  CampaignRun search;  // as all of its steps have them
  search.directory = directory + "/search";
  TRY(UseWorkers(context, options.running, experiment, {.experiment_file = options.experiment.experiment},
                 search));
  if (options.dry_run)
    return PrintPlan(context, options, experiment, plan, examination, search.MostWorkers());
  TRY(Claim(directory, WriteExperiment(experiment, {fmt::format("{} runs", plan.runs)}, BuiltInCatalogue())));
  // Looked at first, as the runs would be for nothing; not held open, as a kill would leave a draft beside
  // it.
  TRY(OutputFile::Open(options.out));
  TRY(const ExitCode code, examination.Run());
  if (code != kExitDone) {
    if (code == kExitStopped || examination.steps() > 1)
      PrintMessage(context, "go on with the whole examination: the same command");
    return code;
  }
  TRY(const ExaminationFacts facts, ReadExamination(directory));
  TRY(WritePage(facts, directory, options.out));
  context.out << (options.running.json ? ExaminationJson(facts, directory, options.out)
                                       : ExaminationText(facts, plan, context.program, options.out))
              << std::flush;
  return kExitDone;
}

}  // namespace

void AddExamine(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "examine", "from a controller to an answer: what breaks it, how, and how surely", RunExamine);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(command, "--budget", "RUNS", options.budget,
           "about so many runs in all (default: 8000; of a program of yours 3000)");
  AddValue(command, "-o,--out", "F", options.out, "the page to write");
  command.footer(
      R"(Runs these commands one after the other, each of which is a campaign below DIR that can be looked at, replayed
and gone on with like any other:
  random           random cases, and the arena without obstacles, which failures are held against
  evolve           an archive search: layouts with few obstacles that break the swarm, each in another way
                   (a genetic search where the scenario does not say along which metrics failures differ)
  confirm          each of them again, in 20 runs with fresh seeds; failures are told apart by this
  minimise, blame  the toughest case of up to three distinct failures: which obstacles does it take?
  margin           faulty robots, and noise of each device that the robots are known to have: from where on does
                   it fail?
and ends with ten lines and a page. A swarm that fails without any obstacle gets no more than the first step.

DIR (default: campaigns/NAME-examined) may hold what an earlier such command has left: after Ctrl-C, or when it
was killed, the same command goes on. The answer is the same for any number of workers. --dry-run names the time
and the commands that are known before, to give them singly. As the job of a cluster:
  sbatch --cpus-per-task 32 --requeue --wrap 'gauntlet examine EXPERIMENT -o report.html'

Examples:
  gauntlet examine flocking -o report.html
  gauntlet examine my.toml --budget 2000 -o report.html
  gauntlet examine foraging --set controller=foraging-improved --dir campaigns/improved -o improved.html)");
}

}  // namespace gauntlet
