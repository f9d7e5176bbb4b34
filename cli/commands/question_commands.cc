// gauntlet evaluate, confirm, minimise, blame, check, compare-controllers: a command for each question about
// cases.
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "analysis/tables/section.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/trusted_path.h"
#include "cli/baseline_run.h"
#include "cli/commands.h"
#include "cli/dry_run.h"
#include "cli/options/sweep.h"
#include "cli/output/output_file.h"
#include "cli/run_campaign.h"
#include "cli/stream_run.h"
#include "master/directory/campaign_directory.h"
#include "study/questions/question_table.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using Place = Question::Place;
using Kind = QuestionOption::Kind;

struct QuestionOptions : LocalOptions {
  Question question;
  SweepOptions sweep;
  bool from_stdin = false;
  std::string place;
  std::vector<std::string> cases;
  std::string other;                                       // a second experiment
  std::vector<std::string> other_sets;                     // for it alone
  std::map<std::string, bool> flags;                       // by the option's name
  std::map<std::string, std::vector<std::string>> values;  // likewise
};

// Settings of the experiments that a new campaign is of.
Result<std::vector<ExtraSet>> ExtraOf(const QuestionOptions& options, const char* search = "cases") {
  const Question& question = options.question;
  for (const ExtraSet& size : SetsOf(options.size)) {
    return InvalidInput(fmt::format("{} {}: '{}' searches nothing; the runs per case are --replicates K",
                                    size.option, size.value, question.name));
  }
  std::vector<ExtraSet> extra = {{question.name, "search.algorithm", search}};
  for (const QuestionOption& option : question.options) {
    const auto given = options.values.find(option.name);
    if (*option.sets != '\0' && given != options.values.end() && !given->second.empty())
      extra.push_back({option.name, option.sets, given->second.back()});
  }
  return extra;
}

// The second one: nothing where none is named.
Result<std::optional<Experiment>> OtherOf(const QuestionOptions& options) {
  if (options.other.empty() && options.other_sets.empty()) return std::optional<Experiment>();
  ExperimentOptions other = options.experiment;
  if (!options.other.empty()) other.experiment = options.other;
  other.sets.insert(other.sets.end(), options.other_sets.begin(), options.other_sets.end());
  TRY(const std::vector<ExtraSet> extra, ExtraOf(options));
  TRY(auto loaded, LoadExperimentWith(other, extra));
  return std::optional(std::move(loaded));
}

Result<Asking> AskingOf(CommandContext& context, const QuestionOptions& options) {
  Asking asking{.place = options.place, .cases = options.cases};
  for (const auto& [name, given] : options.flags) {
    if (given) asking.options[name] = {};
  }
  for (const auto& [name, values] : options.values) {
    if (!values.empty()) asking.options[name] = values;
  }
  asking.program = context.program;
  asking.quiet = options.running.quiet;
  asking.say = [&context](const std::string& message) { PrintMessage(context, message); };
  if (options.question.place != Place::kNewCampaign) return asking;
  const std::string& first = options.experiment.experiment;
  if (*options.question.other != '\0' && CampaignDirectory::IsCampaign(first)) {
    if (!options.other.empty() || !asking.options.empty() || !options.experiment.sets.empty() ||
        !options.running.slurm.empty() || options.dry_run)
      return InvalidInput(first + " is a campaign: what it compares is decided, it is told again alone");
    asking.place = first;
    return asking;
  }
  TRY(const std::vector<ExtraSet> extra, ExtraOf(options));
  if (options.question.sweeps) {
    TRY(asking.experiments, PlanSearches(options.experiment, extra, options.sweep));
    if (!options.running.quiet) TellOfIdleSettings(context, asking.experiments);
    asking.experiment = asking.experiments.front().experiment;
    return asking;
  }
  TRY(asking.experiment, LoadExperimentWith(options.experiment, extra));
  TRY(asking.other, OtherOf(options));
  if (asking.other) asking.other->seed = asking.experiment.seed;
  return asking;
}

// The campaign begins, or goes on where an earlier call with the same cases was stopped.
Result<CampaignRun> RunOfCall(CommandContext& context, const Call& call, const RunningOptions& running,
                              const JobsSource& source) {
  std::size_t cases = 0;
  for (const SearchPlan& search : call.searches) cases += search.cases.size();
  CampaignRun campaign;
  campaign.directory = call.directory;
  campaign.same_command_resumes = true;
  TRY(UseWorkers(context, running, call.searches.front().experiment, source, campaign));
  campaign.announcement = fmt::format("{} with fresh seeds, {}, in {}", Counted(cases, "case"),
                                      campaign.WorkersText(), call.directory);
  campaign.serving = running;
  campaign.run = [&context, &call](const SessionOptions& session) {
    return CampaignDirectory::IsCampaign(call.directory)
               ? context.campaigns.Resume(call.directory, session)
               : context.campaigns.Start(call.directory, call.searches, session);
  };
  return campaign;
}

Result<CampaignRun> RunOfNewCampaign(CommandContext& context, Call& call, const QuestionOptions& options) {
  TRY(CampaignRun campaign, LocalRun(context, call.searches, options));
  call.directory = campaign.directory;
  campaign.run = [&context, &call](const SessionOptions& session) {
    return context.campaigns.Start(call.directory, call.searches, session);
  };
  return campaign;
}

// What has ended is done anew; what was stopped is gone on with.
Result<bool> IsReplaced(CommandContext& context, const Call& call) {
  if (!call.anew || !CampaignDirectory::IsCampaign(call.directory)) return false;
  TRY(const CampaignSummary earlier, context.campaigns.Read(call.directory));
  if (!earlier.finished) return false;
  TRY(const bool lives, context.campaigns.MasterLives(call.directory));
  return !lives;
}

Status Remove(const std::string& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", directory, error.message())};
  return Ok{};
}

// Whoever keeps the corpus under version control does not mean the runs.
Status MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", folder, error.message())};
  if (fs::exists(folder + "/.gitignore", error)) return Ok{};
  return ReplaceFile(folder + "/.gitignore", "*\n", kReadableByAll);
}

// Files that are named by options, opened before the runs, which would be for nothing without them.
using Outputs = std::map<std::string, OutputFile>;

Result<Outputs> OpenOutputs(const QuestionOptions& options) {
  Outputs outputs;
  for (const QuestionOption& option : options.question.options) {
    const auto given = options.values.find(option.name);
    if (option.kind != Kind::kOutput || given->second.empty()) continue;
    TRY(OutputFile opened, OutputFile::Open(given->second.back()));
    outputs.emplace(option.name, std::move(opened));
  }
  return outputs;
}

// What is there already stays: the campaign may be somebody's who may only read it.
Status Keep(const KeptFile& file) {
  std::error_code none;
  if (!file.replaces && fs::exists(file.path, none)) return Ok{};
  return WriteOwnFile(file.path, file.content);
}

ExitCode CodeOf(Conclusion conclusion) {
  return conclusion == Conclusion::kDone       ? kExitDone
         : conclusion == Conclusion::kNegative ? kExitNegative
                                               : kExitUsage;
}

// Prints and keeps what is known by now.
Result<ExitCode> Tell(CommandContext& context, const QuestionOptions& options, const Asking& asking,
                      const Call& call, Outputs& outputs) {
  TRY(const std::vector<CaseAnswer> answers, AnswersTo(options.question, asking, call));
  if (answers.empty()) return kExitDone;  // it was stopped before
  TRY(const Told told, options.question.tell(asking, call, answers));
  Table files({"", ""});
  for (const KeptFile& file : told.files) {
    TRY(Keep(file));
    if (!file.what.empty()) files.AddRow({ShellQuoted(file.path), "# " + file.what});
  }
  context.out << (options.running.json ? told.json : ToText(told.section) + files.ToText() + told.details)
              << std::flush;
  for (auto& [option, file] : outputs) {
    TRY(file.Write(told.outputs.at(option)));
    TRY(file.Close());
  }
  for (const std::string& message : told.messages) PrintMessage(context, message);
  return CodeOf(told.conclusion);
}

// The question as cases come line by line.
Result<ExitCode> RunAsStream(CommandContext& context, const QuestionOptions& options) {
  const auto given = [](const auto& named) { return !named.second.empty() && named.first != "--replicates"; };
  if (options.dry_run || !options.sweep.sweeps.empty() || !options.sweep.seeds.empty() ||
      std::ranges::any_of(options.values, given))
    return InvalidInput(
        "--stdin goes without --case, --from, --sweep, --seeds and --dry-run: lines say what is asked");
  TRY(const std::vector<ExtraSet> extra, ExtraOf(options, "stream"));
  return RunStream(context, options, extra);
}

Result<ExitCode> RunQuestion(CommandContext& context, const QuestionOptions& options) {
  const Place place = options.question.place;
  TRY(CheckWorkers(options.running));
  if (options.from_stdin) return RunAsStream(context, options);
  TRY(const Asking asking, AskingOf(context, options));
  TRY(Call call, PlanCall(options.question, asking));
  TRY(Outputs outputs, OpenOutputs(options));
  if (!call.Simulates()) return Tell(context, options, asking, call, outputs);
  if (place == Place::kCampaign) {
    TRY(CheckOnlyWeWrite(options.place));
  }
  TRY(const bool replaced, IsReplaced(context, call));
  const JobsSource source{.parent = place == Place::kCampaign ? options.place : "", .anew = replaced};
  TRY(CampaignRun campaign, place == Place::kNewCampaign ? RunOfNewCampaign(context, call, options)
                                                         : RunOfCall(context, call, options.running, source));
  if (options.dry_run) return PrintDryRun(context, campaign, call.searches);
  if (replaced) {
    TRY(Remove(call.directory));
  }
  if (place == Place::kCorpus) {
    TRY(MakeFolder(FolderOf(options.question, options.place)));
  }
  if (options.question.looks_at_empty_arena) LookAtEmptyArena(context, options.place, campaign);
  ExitCode told = kExitDone;
  campaign.report = [&](const SessionReport& report) -> Status {
    if (report.end == CampaignEnd::kStopped && place == Place::kCorpus) return Ok{};
    call.summary = &report.summary;
    TRY(told, Tell(context, options, asking, call, outputs));
    return Ok{};
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  return code == kExitDone ? told : code;
}

void AddPlace(CLI::App& command, const Question& question, QuestionOptions& options) {
  if (question.place == Place::kNewCampaign) {
    AddLocalOptions(command, options, /*sizes=*/false);
    if (question.sweeps) AddSweepOptions(command, options.sweep, "random_faults.count=0,2,4");
    if (question.streams) {
      command.add_flag("--stdin", options.from_stdin,
                       "cases come line by line on stdin instead, answers go to stdout; see below");
    }
    if (*question.other == '\0') return;
    command.add_option("OTHER", options.other, question.other);
    AddValue(command, "--set-b", "KEY=VALUE", options.other_sets,
             "change one value of the other experiment alone (--set: of both); repeatable");
    return;
  }
  if (question.place == Place::kCorpus) {
    command.add_option("CORPUS", options.place, "folder of cases, made by 'gauntlet corpus add'")->required();
    return;
  }
  AddDirectory(command, options.place);
  if (question.named == Question::Named::kNone) return;
  const bool one = question.named == Question::Named::kOne;
  CLI::Option* cases = command.add_option("CASE", options.cases,
                                          one ? "the run of the campaign whose case is meant, or a case file"
                                              : "runs of the campaign whose cases are meant, or case files");
  if (one) cases->expected(1);
  if (question.named != Question::Named::kAny) cases->required();
}

void AddOption(CLI::App& command, const QuestionOption& option, QuestionOptions& options) {
  if (option.kind == Kind::kFlag) {
    command.add_flag(option.name, options.flags[option.name], option.help);
    return;
  }
  std::vector<std::string>& values = options.values[option.name];
  if (option.kind == Kind::kPlugins) return AddPluginOption(command, values);
  if (option.kind == Kind::kValues) return AddValue(command, option.name, option.type, values, option.help);
  CLI::Option* added = command.add_option(option.name, values, option.help)->type_name(option.type);
  if (option.kind != Kind::kFiles) added->expected(1);
}

void AddQuestion(CommandParser& parser, const Question& question) {
  const auto [command, options] = parser.Add(question.name, question.summary, RunQuestion);
  options.question = question;
  AddPlace(command, question, options);
  for (const QuestionOption& option : question.options) AddOption(command, option, options);
  if (question.place != Place::kNewCampaign) {
    AddRunningOptions(command, options.running);
    AddJobsOption(command, options.running);
  }
  command.footer(question.help);
}

}  // namespace

void AddQuestions(CommandParser& parser) {
  for (const auto question : kQuestions) AddQuestion(parser, question());
}

}  // namespace gauntlet
