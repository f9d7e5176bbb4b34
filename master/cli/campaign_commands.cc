// gauntlet resume, gauntlet show: a campaign that exists.

#include <cstdlib>

#include <fmt/format.h>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"
#include "master/cli/submitted_campaign.h"

namespace gauntlet::master {
ExitCode RunResume(CommandContext& context, const CommonOptions& options) {
  if (options.bind.empty() && options.workers.empty()) {
    const Result<std::optional<SlurmCampaign>> submitted = FindSubmitted(options.directory);
    if (!submitted) return Fail(context, submitted.error());
    if (submitted->has_value() && options.as_job) {
      const char* job = std::getenv("SLURM_JOB_ID");
      return ServeSubmitted(context, options, options.directory, **submitted,
                            job != nullptr ? job : "unknown");
    }
    if (submitted->has_value()) return ResumeSubmitted(context, options, **submitted);
  }
  if (options.as_job)
    return Fail(context,
                InvalidInput(fmt::format("--as-job: {} was not submitted to Slurm, or --workers or --bind "
                                         "is given; use 'submit'",
                                         options.directory)));
  // With --bind workers come from elsewhere, unless some are asked for.
  const bool none = !options.bind.empty() && options.workers.empty();
  const Result<int> workers = none ? Result<int>(0) : ParseWorkers(options.workers);
  if (!workers) return Fail(context, workers.error());
  CampaignRun campaign;
  campaign.bind = options.bind;
  campaign.insecure = options.insecure;
  campaign.directory = options.directory;
  campaign.workers = *workers;
  campaign.run = [&](const SessionOptions& session) {
    return context.service.resume(options.directory, session);
  };
  campaign.report = [&](const SessionReport& report) -> Status {
    if (!options.quiet && report.runs_this_session == 0 && report.summary.finished) {
      PrintMessage(context, fmt::format("{} is finished, nothing was left to do", options.directory));
    }
    PrintSummary(context, report.summary, options.directory, options.json);
    return Ok{};
  };
  return RunCampaign(context, options, campaign);
}

ExitCode RunShow(CommandContext& context, const CommonOptions& options) {
  const Result<CampaignSummary> summary = context.service.read(options.directory);
  if (!summary) return Fail(context, summary.error());
  PrintSummary(context, *summary, options.directory, options.json);
  return kExitDone;
}

}  // namespace gauntlet::master
