#include "master/cli/run_campaign.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "master/cli/progress.h"
#include "master/cli/stop_signal.h"
#include "master/cli/summary_json.h"
#include "master/cli/summary_text.h"
#include "master/cli/table.h"
#include "master/dispatch/curve_keys.h"
#include "master/search/search_table.h"
#include "master/session/bind_endpoint.h"
#include "master/session/metrics_server.h"

namespace gauntlet::master {
namespace {

std::string ResumeHint(const CommandContext& context, const std::string& directory) {
  return fmt::format("{} resume {}", context.program, ShellQuoted(directory));
}

// Whether there is anything to resume decides how to go on after an error.
std::string HowToGoOn(const CommandContext& context, const std::string& directory, bool began) {
  std::error_code ignored;
  if (std::filesystem::exists(directory + "/campaign.db", ignored)) {
    return fmt::format("stopped; what was finished is stored. Go on with: {}",
                       ResumeHint(context, directory));
  }
  if (began) {
    return fmt::format("stopped; what was finished is stored where {} is now. Go on with: {} resume THERE",
                       directory, context.program);
  }
  return fmt::format("nothing was simulated. When there is space, the same command with --dir {} starts anew",
                     ShellQuoted(directory));
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
    line += fmt::format(", {}", workers.nondeterministic == 0
                                    ? "all equal"
                                    : fmt::format("{} ENDED DIFFERENTLY", workers.nondeterministic));
  }
  return line;
}

}  // namespace

ExitCode RunCampaign(CommandContext& context, const CommonOptions& options, const CampaignRun& campaign) {
  const Result<double> audit_share = ParseShare("--audit", options.audit);
  if (!audit_share) return Fail(context, audit_share.error());
  if (!campaign.bind.empty()) {
    if (const Status possible = CheckBindEndpoint(campaign.bind); !possible)
      return Fail(context, possible.error());
  }
  if (!options.quiet && !campaign.announcement.empty()) PrintMessage(context, campaign.announcement);

  const SteadyClock clock;
  const ProgressMode mode = ChooseProgressMode(!options.quiet && !options.no_progress,
                                               context.err_is_terminal, std::getenv("TERM"));
  ProgressPrinter progress(
      mode, clock, [&](const std::string& text) { context.err << text << std::flush; }, TerminalColumns);
  bool began = false;

  std::unique_ptr<MetricsServer> metrics;
  if (!options.metrics_port.empty()) {
    const Result<int> port = ParseMetricsPort(options.metrics_port);
    if (!port) return Fail(context, port.error());
    Result<std::unique_ptr<MetricsServer>> started = MetricsServer::Start(*port);
    if (!started) return Fail(context, started.error());
    metrics = *std::move(started);
    if (!options.quiet) PrintMessage(context, fmt::format("metrics at {}", metrics->url()));
  }

  SessionOptions session;
  session.metrics = metrics.get();
  session.workers = campaign.workers;
  session.insecure = campaign.insecure;
  session.audit_share = *audit_share;
  session.batch_job = campaign.batch_job;
  session.make_pool = campaign.make_pool;
  if (!campaign.bind.empty()) session.bind = campaign.bind;
  session.on_serving = [&](const ServingNotice& notice) {
    if (campaign.bind.empty()) return;
    if (!notice.encrypted && !IsLocalEndpoint(campaign.bind)) {
      // Said even with --quiet.
      const char* red = context.err_is_terminal ? "\x1b[1;31m" : "";
      const char* plain = context.err_is_terminal ? "\x1b[0m" : "";
      context.err << red << std::flush;
      PrintMessage(context,
                   fmt::format("INSECURE: whoever reaches {} can read this campaign and feed it results; "
                               "nothing is encrypted or checked",
                               notice.endpoints.front()));
      context.err << plain << std::flush;
    }
    if (options.quiet) return;
    if (campaign.make_pool) {
      PrintMessage(context, fmt::format("workers connect to {}{}", notice.endpoints.front(),
                                        notice.encrypted ? ", encrypted" : ""));
      return;
    }
    PrintMessage(context, fmt::format("workers connect to {}{}; start them with: gauntlet-worker --dir {}",
                                      notice.endpoints.front(), notice.encrypted ? ", encrypted" : "",
                                      ShellQuoted(campaign.directory)));
  };
  session.stop_requested = StopSignal::Requested;
  session.on_progress = [&](const CampaignProgress& now) {
    began = true;
    progress.Update(now);
  };
  Result<SessionReport> report = [&] {
    const StopSignal handlers;
    return campaign.run(session);
  }();
  progress.Finish();
  if (!report) {
    const ErrorKind kind = report.error().kind;
    const bool resumable =
        kind == ErrorKind::kNoSpace || (began && (kind == ErrorKind::kIo || kind == ErrorKind::kInUse));
    const ExitCode code = Fail(context, report.error());
    if (!resumable) return code;
    PrintMessage(context, HowToGoOn(context, campaign.directory, began));
    return kExitStopped;
  }
  if (!options.quiet && report->runs_this_session > 0) PrintMessage(context, Timing(*report));
  if (const Status printed = campaign.report(*report); !printed) return Fail(context, printed.error());
  if (report->end == CampaignEnd::kStopped) {
    PrintMessage(context, fmt::format("stopped after {} runs, all of them stored. Go on with: {}",
                                      FormatCount(report->summary.runs_done),
                                      ResumeHint(context, campaign.directory)));
    return kExitStopped;
  }
  // `evaluate` judges its cases itself.
  const CampaignSummary& summary = report->summary;
  const SearchRow* search = FindSearch(summary.search);
  const bool given_cases = search != nullptr && search->given_cases;
  if (!given_cases && summary.runs_done > 0 && summary.runs_failed == summary.runs_done) {
    const std::string why =
        summary.runs_without_result.empty() ? "" : ", most often: " + summary.runs_without_result[0].message;
    PrintMessage(context,
                 fmt::format("none of the {} runs gave a result{}", FormatCount(summary.runs_done), why));
    return kExitNegative;
  }
  return kExitDone;
}

void PrintSummary(CommandContext& context, const CampaignSummary& summary, const std::string& directory,
                  bool json) {
  context.out << (json ? SummaryJson(summary, directory) : SummaryText(summary, {context.program, directory}))
              << std::flush;
}

std::string Announcement(const Experiment& experiment, int workers, const std::string& directory) {
  const SearchRow& search = RowOf(experiment);
  return fmt::format("{}: {}, {}, seed {}, {} worker{}, in {}", experiment.name, search.title,
                     search.plan(experiment), experiment.seed, workers, workers == 1 ? "" : "s", directory);
}

}  // namespace gauntlet::master
