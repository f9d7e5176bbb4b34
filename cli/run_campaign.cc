#include "cli/run_campaign.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "analysis/tables/table.h"
#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/baseline_run.h"
#include "cli/dry_run.h"
#include "cli/options/stop_signal.h"
#include "cli/output/progress.h"
#include "cli/output/summary.h"
#include "cli/submitted_campaign.h"
#include "master/directory/campaign_directory.h"
#include "master/session/bind_endpoint.h"
#include "master/session/metrics_page.h"
#include "proto/run_failure.h"
#include "report/tables/summary_tables.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/questions/chosen_cases.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

std::string ResumeHint(const CommandContext& context, const CampaignRun& campaign) {
  if (campaign.same_command_resumes) return "the same command";
  if (!campaign.goes_on_by.empty()) return fmt::format("{} {}", context.program, campaign.goes_on_by);
  const std::string& directory = campaign.resumed_by.empty() ? campaign.directory : campaign.resumed_by;
  return fmt::format("{} resume {}", context.program, PastedPath(directory));
}

// Whether there is anything to resume decides how to go on after an error.
std::string HowToGoOn(const CommandContext& context, const CampaignRun& campaign) {
  if (CampaignDirectory::IsCampaign(campaign.directory)) {
    return fmt::format("stopped; what was finished is stored. Go on with: {}", ResumeHint(context, campaign));
  }
  return fmt::format("nothing was simulated. When there is room, the same command with --dir {} starts anew",
                     PastedPath(campaign.directory));
}

std::string Timing(const SessionReport& report) {
  std::string line = fmt::format("{} runs in {}", FormatCount(report.runs_this_session),
                                 FormatDuration(report.wall_seconds));
  if (report.runs_this_session > 0 && report.wall_seconds > 0) {
    const auto runs = static_cast<double>(report.runs_this_session);
    line += fmt::format(" ({:.1f}/s; master {:.0f} us of CPU per run)", runs / report.wall_seconds,
                        1e6 * report.master_cpu_seconds / runs);
  }
  const WorkerStatistics& workers = report.workers;
  if (workers.slot_seconds > 0.0) {
    line +=
        fmt::format("; workers idle for {:.0f} % of {} ({:.0f} % because the search waited for results)",
                    100.0 * workers.idle_seconds / workers.slot_seconds, FormatDuration(workers.slot_seconds),
                    100.0 * workers.barrier_seconds / workers.slot_seconds);
  }
  if (workers.audits > 0) {
    line += fmt::format("; {} runs simulated on a second worker",
                        FormatCount(workers.audits - workers.audits_alone));
    if (workers.audits_alone > 0)
      line += fmt::format(", {} again on the only one there was", FormatCount(workers.audits_alone));
    const std::uint64_t different = workers.nondeterministic + workers.differences;
    line += different == 0 ? ", all equal" : fmt::format(", {} ENDED DIFFERENTLY", different);
  }
  return line;
}

// Where workers connect, and that nothing protects the campaign when that is so.
void PrintServing(CommandContext& context, const CampaignRun& campaign, const ServingNotice& notice) {
  const std::string& endpoint = notice.endpoints.front();
  if (!notice.encrypted) {
    // Said even with --quiet.
    context.err << (context.err_is_terminal ? "\x1b[1;31m" : "") << std::flush;
    PrintMessage(context,
                 fmt::format("INSECURE: whoever reaches {} can read this campaign and feed it results; "
                             "nothing is encrypted or checked",
                             endpoint));
    context.err << (context.err_is_terminal ? "\x1b[0m" : "") << std::flush;
  }
  if (campaign.serving.quiet || (campaign.bind.endpoint.empty() && !campaign.jobs)) return;
  // The worker beside this program, as a person who started this one can start it.
  const std::string start = campaign.jobs ? ""
                                          : fmt::format("; start them with: {}-worker --dir {}",
                                                        context.program, PastedPath(campaign.directory));
  PrintMessage(context, fmt::format("workers connect to {}{}{}", endpoint,
                                    notice.encrypted ? ", encrypted" : "", start));
}

// Said before anything is started: the person may have meant another number.
void WarnOfManyWorkers(CommandContext& context, int workers) {
  constexpr int kManyPerCore = 4;
  const int cores = AvailableCores();
  if (workers <= kManyPerCore * cores) return;
  PrintMessage(context, fmt::format("warning: {} workers on {}: more than {} make nothing faster, and "
                                    "each takes memory and three processes",
                                    workers, Counted(cores, "core"), cores));
}

Result<std::unique_ptr<MetricsPage>> StartMetrics(CommandContext& context, const ServingOptions& options) {
  if (options.metrics_port.empty()) return std::unique_ptr<MetricsPage>();
  TRY(const int port, ParsePort("--metrics-port", options.metrics_port));
  Result<std::unique_ptr<MetricsPage>> metrics = MetricsPage::Serve(port);
  if (metrics && !options.quiet) PrintMessage(context, fmt::format("metrics at {}", (*metrics)->url()));
  return metrics;
}

// `began`: some progress was made.
Result<ExitCode> FailCampaign(CommandContext& context, const CampaignRun& campaign, const Error& error,
                              bool began) {
  const bool in_use = error.kind == ErrorKind::kInUse;
  const bool asked_now = in_use && campaign.same_command_resumes && !began;
  // What was deleted or replaced under this master says itself what is left.
  const bool gone = began && error.kind == ErrorKind::kNotFound;
  const bool resumable = error.kind == ErrorKind::kNoSpace ||
                         (began && (error.kind == ErrorKind::kIo || in_use)) ||
                         (in_use && StopSignal::Requested());
  if (!asked_now && !gone && !resumable) return error;
  PrintMessage(context, error.message);
  if (asked_now)
    PrintMessage(context, "the same question is being answered just now; when that has ended, ask again");
  if (resumable) PrintMessage(context, HowToGoOn(context, campaign));
  return gone || resumable ? kExitStopped : kExitUsage;
}

Result<ExitCode> Conclude(CommandContext& context, const CampaignRun& campaign, const SessionReport& report) {
  const CampaignSummary& summary = report.summary;
  if (!campaign.serving.quiet && report.runs_this_session > 0) PrintMessage(context, Timing(report));
  if (campaign.report) {
    TRY(campaign.report(report));
  } else {
    const bool nothing_left = report.runs_this_session == 0 && summary.finished;
    TRY(nothing_left ? PrintFinished(context, summary, campaign.directory, campaign.serving)
                     : PrintSummary(context, summary, campaign.directory, campaign.serving.json));
  }
  if (report.end == CampaignEnd::kStopped) {
    PrintMessage(context, fmt::format("stopped after {} runs, all of them stored. Go on with: {}",
                                      FormatCount(summary.runs_done), ResumeHint(context, campaign)));
    return kExitStopped;
  }
  // `evaluate` judges its cases itself.
  const SearchSummary* only = summary.OnlySearch();
  const SearchRow* search = only == nullptr ? nullptr : FindSearch(only->search);
  const bool given_cases = search != nullptr && search->given_cases();
  if (!given_cases && summary.runs_done > 0 && summary.runs_failed == summary.runs_done) {
    const std::string why = only == nullptr || only->runs_without_result.empty()
                                ? ""
                                : ", most often: " + proto::Explained(only->runs_without_result[0].message);
    PrintMessage(context,
                 fmt::format("none of the {} runs gave a result{}", FormatCount(summary.runs_done), why));
    return kExitNegative;
  }
  if (report.workers.nondeterministic > 0) {
    if (!summary.plugin_controllers.empty()) PrintMessage(context, Printable(WhyNotReproducible(summary)));
    return kExitNegative;
  }
  return kExitDone;
}

}  // namespace

Result<ExitCode> RunCampaign(CommandContext& context, const CampaignRun& campaign) {
  const ServingOptions& options = campaign.serving;
  const std::string& endpoint = campaign.jobs ? campaign.jobs->settings().bind : campaign.bind.endpoint;
  TRY(const double audit_share, ParseShare("--audit", options.audit));
  TRY(endpoint.empty() ? Status(Ok{}) : CheckBindEndpoint(endpoint));
  if (!options.quiet && !campaign.announcement.empty()) PrintMessage(context, campaign.announcement);
  WarnOfManyWorkers(context, campaign.session.workers);
  TRY(const std::unique_ptr<MetricsPage> metrics, StartMetrics(context, options));

  const SteadyClock clock;
  const ProgressMode mode = ChooseProgressMode(!options.quiet && !options.no_progress,
                                               context.err_is_terminal, std::getenv("TERM"));
  ProgressPrinter progress(
      mode, clock, [&](const std::string& text) { context.err << text << std::flush; }, TerminalColumns);
  bool began = false;

  SessionOptions session = campaign.session;
  session.metrics = metrics.get();
  session.insecure = campaign.bind.insecure;
  session.audit_share = audit_share;
  if (!endpoint.empty()) session.bind = endpoint;
  if (!endpoint.empty() || session.insecure)
    session.on_serving = [&](const ServingNotice& notice) { PrintServing(context, campaign, notice); };
  if (campaign.jobs) UseJobs(context, *campaign.jobs, session);
  session.stop_requested = StopSignal::Requested;
  session.on_progress = [&](const CampaignProgress& now) {
    began = true;
    progress.Update(now);
  };
  const Result<SessionReport> report = [&] {
    const StopSignal handlers;
    return campaign.run(session);
  }();
  progress.Finish();
  if (report && report->end == CampaignEnd::kFinished && campaign.looks_at_empty_arena)
    LookAtEmptyArena(context, campaign.directory, campaign);
  return report ? Conclude(context, campaign, *report)
                : FailCampaign(context, campaign, report.error(), began);
}

void PrintAsOf(CommandContext& context, const std::string& directory, const std::string& as_of) {
  if (as_of.empty()) return;
  PrintMessage(context, fmt::format("{} is served from another machine; this is what was stored {}",
                                    directory, as_of));
}

Status PrintSummary(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                    bool json) {
  TRY(const CampaignAnswers answers, ReadAnswers(directory));
  context.out << (json ? SummaryJson(summary, answers, directory)
                       : SummaryText(summary, answers, {context.program, directory}))
              << std::flush;
  return Ok{};
}

Status PrintFinished(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                     const MessageOptions& options) {
  if (!options.quiet) PrintMessage(context, fmt::format("{} is finished, nothing was left to do", directory));
  return PrintSummary(context, summary, directory, options.json);
}

int CampaignRun::MostWorkers() const {
  if (!jobs) return session.workers;
  const slurm::PoolLimits pool = jobs->limits();
  return pool.max_allocations * pool.workers_per_allocation;
}

std::string CampaignRun::WorkersText() const {
  return jobs ? "workers from " + jobs->cluster().name : Counted(session.workers, "worker");
}

Status CheckWorkers(const RunningOptions& options) {
  if (options.slurm.empty()) {
    TRY(ParseWorkers(options.workers));
    return Ok{};
  }
  if (!options.workers.empty()) return InvalidInput("--slurm goes without --workers: workers are jobs");
  TRY(slurm::ReadSlurmSettings({}, options.slurm));
  if (std::ranges::count(options.slurm, "master=job") > 0)
    return InvalidInput("--slurm master=job: the master stays here, unless 'submit' makes it a job");
  return Ok{};
}

Status UseWorkers(CommandContext& context, const RunningOptions& options, const Experiment& experiment,
                  const JobsSource& source, CampaignRun& campaign) {
  TRY(CheckWorkers(options));
  std::optional<slurm::SlurmCampaign> like;
  if (!source.anew) {
    TRY(like, slurm::SlurmCampaign::Find(campaign.directory));
  }
  if (options.slurm.empty()) {
    TRY(campaign.session.workers, ParseWorkers(options.workers));
    if (options.workers.empty()) campaign.jobs = std::move(like);
    return Ok{};
  }
  const bool of_its_own = like.has_value();
  if (!like && !source.parent.empty()) {
    TRY(like, slurm::SlurmCampaign::Find(source.parent));
  }
  const std::string before = like ? slurm::WriteSlurmSettings(like->settings()) : "";
  std::optional<slurm::SlurmSource> file;
  if (like) {
    file = {before, "slurm.toml", true};
  } else if (!source.experiment_file.empty()) {
    TRY(const ExperimentText text, ReadExperimentText(source.experiment_file));
    file = {text.text, text.file_name, false};
  }
  TRY(slurm::SlurmSettings settings, ReadSlurmOptions({"here", options.slurm}, file, experiment.name));
  const bool slots_are_new = !like || std::ranges::any_of(options.slurm, [](const std::string& set) {
    return set.starts_with("workers_per_allocation=");
  });
  if (slots_are_new) {
    TRY(AskForCores(experiment, settings));
  }
  TRY(slurm::SlurmCampaign jobs, slurm::SlurmCampaign::Make(settings, campaign.directory));
  const std::string text = slurm::WriteSlurmSettings(settings);
  if (text != before) {
    TRY(TestJobs(context, jobs, /*print=*/false));
  }
  if (!of_its_own || text != before) campaign.session.slurm = text;
  campaign.jobs = std::move(jobs);
  return Ok{};
}

Result<CampaignRun> LocalRun(CommandContext& context, const std::vector<SearchPlan>& searches,
                             const LocalOptions& options) {
  const Experiment& experiment = searches.front().experiment;
  TRY(const std::string directory, NewDirectory(options.experiment.directory, experiment));
  const SearchRow& search = RowOf(experiment);
  CampaignRun campaign;
  campaign.directory = directory;
  TRY(UseWorkers(context, options.running, experiment, {.experiment_file = options.experiment.experiment},
                 campaign));
  const std::string what =
      searches.size() == 1
          ? fmt::format("{}, {}, seed {}", search.title, search.plan(experiment), experiment.seed)
          : fmt::format("{} searches ({}; ...; {})", searches.size(), searches.front().settings,
                        searches.back().settings);
  campaign.announcement =
      fmt::format("{}: {}, {}, in {}", experiment.name, what, campaign.WorkersText(), directory);
  campaign.serving = options.running;
  return campaign;
}

Result<ExitCode> RunAndTell(CommandContext& context, const std::vector<SearchPlan>& searches,
                            const LocalOptions& options,
                            const std::function<Result<ExitCode>(const std::string& directory)>& tell) {
  TRY(CampaignRun campaign, LocalRun(context, searches, options));
  if (options.dry_run) return PrintDryRun(context, campaign, searches);
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Start(campaign.directory, searches, session);
  };
  ExitCode told = kExitDone;
  campaign.report = [&](const SessionReport& report) -> Status {
    if (report.end == CampaignEnd::kStopped) return Ok{};
    TRY(told, tell(campaign.directory));
    return Ok{};
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  return code == kExitDone ? told : code;
}

Result<std::vector<sim::TestCase>> GivenCases(CommandContext& context, const std::string& on,
                                              const Experiment& experiment, bool quiet) {
  TRY(const ChosenCases chosen, ChooseCases(on, experiment));
  std::vector<sim::TestCase> cases;
  std::size_t refused = 0;
  for (const ChosenCases::Group& group : chosen.groups) {
    for (const sim::TestCase& one : group.cases) {
      if (RefusalOf(experiment, one)) {
        ++refused;
      } else {
        cases.push_back(one);
      }
    }
  }
  if (quiet) return cases;
  for (const std::string& note : chosen.notes) PrintMessage(context, note);
  if (refused > 0) PrintMessage(context, Counted(refused, "case") + " left out, as a rule is broken");
  return cases;
}

}  // namespace gauntlet
