#include "cli/baseline_run.h"

#include "cli/options/stop_signal.h"
#include "cli/submitted_campaign.h"
#include "master/directory/campaign_directory.h"
#include "study/questions/baselines.h"

namespace gauntlet {
namespace {

Status Look(CommandContext& context, const std::string& directory, const CampaignRun& run) {
  TRY(const Call call, PlanCall(BaselineQuestion(), {.place = directory}));
  if (!call.Simulates()) return Ok{};
  SessionOptions session;
  session.workers = run.session.workers;
  std::optional<slurm::SlurmCampaign> jobs;
  if (run.jobs) {
    TRY(jobs, slurm::SlurmCampaign::Make(run.jobs->settings(), call.directory));
    UseJobs(context, *jobs, session);
    session.slurm = slurm::WriteSlurmSettings(jobs->settings());
  }
  session.stop_requested = StopSignal::Requested;
  const StopSignal handlers;
  TRY(CampaignDirectory::IsCampaign(call.directory)
          ? context.campaigns.Resume(call.directory, session)
          : context.campaigns.Start(call.directory, call.searches, session));
  return Ok{};
}

}  // namespace

void LookAtEmptyArena(CommandContext& context, const std::string& directory, const CampaignRun& run) {
  if (!CampaignDirectory::IsCampaign(directory) || (run.session.workers == 0 && !run.jobs)) return;
  const Status looked = Look(context, directory, run);
  if (!looked && !StopSignal::Requested())
    PrintMessage(context, "nobody has looked at the arena without obstacles: " + looked.error().message);
}

}  // namespace gauntlet
