// gauntlet resume: go on with a campaign.
#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/shell_quoted.h"
#include "master/cli/commands.h"
#include "master/cli/run_campaign.h"
#include "master/cli/submitted_campaign.h"

namespace gauntlet::master {
namespace {

struct ResumeOptions {
  std::string directory;
  RunningOptions running;
  BindOptions bind;
  bool as_job = false;
};

// The master's job of a submitted campaign, handed to Slurm again unless it is there.
ExitCode SubmitAgain(CommandContext& context, const ResumeOptions& options,
                     const slurm::SlurmCampaign& campaign) {
  const std::string& directory = options.directory;
  const Result<CampaignSummary> summary = context.campaigns.Read(directory);
  if (!summary) return Fail(context, summary.error());
  if (summary->finished) {
    PrintFinished(context, *summary, directory, options.running);
    return kExitDone;
  }
  const Result<std::vector<slurm::JobStatus>> jobs = campaign.LivingJobs(*context.slurm());
  if (!jobs) return Fail(context, jobs.error());
  for (const slurm::JobStatus& job : *jobs) {
    if (job.name != campaign.master_job_name()) continue;
    return Fail(context, Error{ErrorKind::kInUse,
                               fmt::format("job {} ({}) is the campaign's master already; see: {} status {}",
                                           job.id, job.state, context.program, ShellQuoted(directory))});
  }
  const Result<std::string> job = SubmitMasterJob(context, directory, campaign);
  if (!job) return Fail(context, job.error());
  context.out << fmt::format("{} goes on as job {}\n", directory, *job) << std::flush;
  return kExitDone;
}

ExitCode RunResume(CommandContext& context, const ResumeOptions& options) {
  const bool bound = !options.bind.endpoint.empty();
  if (!bound && options.running.workers.empty()) {
    const Result<std::optional<slurm::SlurmCampaign>> submitted =
        slurm::SlurmCampaign::Find(options.directory);
    if (!submitted) return Fail(context, submitted.error());
    if (submitted->has_value()) {
      const char* job = std::getenv("SLURM_JOB_ID");
      if (options.as_job)
        return ServeSubmitted(context, options.running, options.directory, **submitted,
                              job != nullptr ? job : "unknown");
      if ((*submitted)->settings().master == slurm::MasterPlace::kHere)
        return ServeSubmitted(context, options.running, options.directory, **submitted, "");
      return SubmitAgain(context, options, **submitted);
    }
  }
  if (options.as_job)
    return Fail(context,
                InvalidInput(fmt::format("--as-job: {} was not submitted to Slurm, or --workers or --bind "
                                         "is given; use 'submit'",
                                         options.directory)));
  // With --bind workers come from elsewhere, unless some are asked for.
  const bool none = bound && options.running.workers.empty();
  const Result<int> workers = none ? Result<int>(0) : ParseWorkers(options.running.workers);
  if (!workers) return Fail(context, workers.error());
  CampaignRun campaign;
  campaign.directory = options.directory;
  campaign.session.workers = *workers;
  campaign.serving = options.running;
  campaign.bind = options.bind;
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Resume(options.directory, session);
  };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddResume(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("resume", "go on with a campaign that was stopped or killed", RunResume);
  AddDirectory(command, options.directory);
  AddRunningOptions(command, options.running);
  AddBindOptions(command, options.bind);
  command.add_flag(
      "--as-job", options.as_job,
      "for the master's job of a submitted campaign: replaces a twin, leaves workers to its successor");
  command.footer(
      R"(Goes on where the campaign was, whatever ended it; no finished run is simulated again, and the result
is that of an undisturbed campaign. A finished campaign is only summarised.

With --bind, workers come from elsewhere, as with 'gauntlet master'. A campaign that was submitted to Slurm
goes on there, unless --workers or --bind is given; jobs of it that are left are used.

Examples:
  gauntlet resume campaigns/flocking-20260131T120000Z --workers 4
  gauntlet resume DIR --bind 'tcp://0.0.0.0:*')");
}

}  // namespace gauntlet::master
