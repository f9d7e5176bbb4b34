#include "master/cli/submitted_campaign.h"

#include <filesystem>

#include <fmt/format.h>

#include "master/cli/run_campaign.h"
#include "master/cli/table.h"

namespace gauntlet::master {

Result<std::optional<SlurmCampaign>> FindSubmitted(const std::string& directory) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(directory, ignored)) return std::optional<SlurmCampaign>();
  Result<SlurmCampaign> campaign = SlurmCampaign::Load(directory);
  if (campaign) return std::optional(*std::move(campaign));
  if (campaign.error().kind == ErrorKind::kNotFound) return std::optional<SlurmCampaign>();
  return campaign.error();
}

ExitCode ServeSubmitted(CommandContext& context, const CommonOptions& options, const std::string& directory,
                        const SlurmCampaign& campaign, const std::string& batch_job) {
  CampaignRun run;
  run.directory = directory;
  run.bind = campaign.settings().bind;
  run.workers = 0;
  run.batch_job = batch_job;
  run.make_pool = [&](const PoolSite&) -> Result<std::unique_ptr<WorkerPool>> {
    return campaign.MakePool(context.slurm());
  };
  bool served = false;
  run.run = [&](const SessionOptions& session) { return context.service.resume(directory, session); };
  run.report = [&](const SessionReport& report) -> Status {
    served = report.runs_this_session > 0 || !report.summary.finished;
    if (!options.quiet && !served)
      PrintMessage(context, fmt::format("{} is finished, nothing was left to do", directory));
    PrintSummary(context, report.summary, directory, options.json);
    return Ok{};
  };
  const ExitCode code = RunCampaign(context, options, run);
  // Of a master that was killed between its last result and its farewell.
  if (code == kExitDone && !served && batch_job.empty()) {
    const Result<std::vector<std::string>> cancelled = CancelJobs(context, campaign);
    if (!cancelled) PrintMessage(context, cancelled.error().message);
  }
  return code;
}

Result<std::string> SubmitMasterJob(CommandContext& context, const std::string& directory,
                                    const SlurmCampaign& campaign) {
  std::error_code error;
  std::filesystem::create_directories(directory + "/log", error);  // Slurm does not make it
  Result<std::string> job = context.slurm()->Submit(campaign.master_script(), {});
  if (!job) {
    const std::string& words = job.error().message;
    return Error{job.error().kind,
                 fmt::format("{}{}. The campaign is made; try again with: {} resume {}", words,
                             slurm::NextStep(words), context.program, ShellQuoted(directory))};
  }
  return job;
}

ExitCode ResumeSubmitted(CommandContext& context, const CommonOptions& options,
                         const SlurmCampaign& campaign) {
  const std::string& directory = options.directory;
  if (campaign.settings().master == MasterPlace::kHere)
    return ServeSubmitted(context, options, directory, campaign, "");
  const Result<CampaignSummary> summary = context.service.read(directory);
  if (!summary) return Fail(context, summary.error());
  if (summary->finished) {
    if (!options.quiet)
      PrintMessage(context, fmt::format("{} is finished, nothing was left to do", directory));
    PrintSummary(context, *summary, directory, options.json);
    return kExitDone;
  }
  const Result<std::vector<slurm::JobStatus>> jobs = LivingJobs(*context.slurm(), campaign);
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

Result<std::vector<std::string>> CancelJobs(CommandContext& context, const SlurmCampaign& campaign) {
  const std::unique_ptr<slurm::SlurmClient> client = context.slurm();
  const Result<std::vector<slurm::JobStatus>> jobs = LivingJobs(*client, campaign);
  if (!jobs) return jobs.error();
  std::vector<std::string> ids;
  for (const slurm::JobStatus& job : *jobs) {
    if (job.phase != slurm::JobPhase::kEnding) ids.push_back(job.id);
  }
  if (Status cancelled = client->Cancel(ids); !cancelled) return cancelled.error();
  return ids;
}

}  // namespace gauntlet::master
