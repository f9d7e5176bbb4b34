#include "master/cli/submitted_campaign.h"

#include <fmt/format.h>

#include "base/shell_quoted.h"
#include "base/system/regular_file.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {

ExitCode ServeSubmitted(CommandContext& context, const ServingOptions& options, const std::string& directory,
                        const slurm::SlurmCampaign& campaign, const std::string& batch_job) {
  CampaignRun run;
  run.directory = directory;
  run.serving = options;
  run.bind.endpoint = campaign.settings().bind;
  run.session.workers = 0;
  run.session.batch_job = batch_job;
  run.session.make_pool = [&] { return campaign.MakePool(context.slurm()); };
  bool served = false;
  run.run = [&](const SessionOptions& session) {
    Result<SessionReport> report = context.campaigns.Resume(directory, session);
    served = report && (report->runs_this_session > 0 || !report->summary.finished);
    return report;
  };
  const ExitCode code = RunCampaign(context, run);
  // Of a master that was killed between its last result and its farewell.
  if (code == kExitDone && !served && batch_job.empty()) {
    const Result<std::vector<std::string>> cancelled = campaign.CancelJobs(*context.slurm());
    if (!cancelled) PrintMessage(context, cancelled.error().message);
  }
  return code;
}

Result<std::string> SubmitMasterJob(CommandContext& context, const std::string& directory,
                                    const slurm::SlurmCampaign& campaign) {
  if (const Status made = MakeDirectory(directory + "/log"); !made) return made.error();  // Slurm makes none
  Result<std::string> job = context.slurm()->Submit(campaign.master_script(), {});
  if (!job) {
    const std::string& words = job.error().message;
    return Error{job.error().kind,
                 fmt::format("{}{}. The campaign is made; try again with: {} resume {}", words,
                             slurm::NextStep(words), context.program, PastedPath(directory))};
  }
  return job;
}

}  // namespace gauntlet::master
