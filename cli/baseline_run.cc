#include "cli/baseline_run.h"

#include "cli/options/stop_signal.h"
#include "master/directory/campaign_directory.h"
#include "study/questions/baselines.h"

namespace gauntlet {
namespace {

Status Look(CommandContext& context, const std::string& directory, int workers) {
  TRY(const Call call, PlanCall(BaselineQuestion(), {.place = directory}));
  if (!call.Simulates()) return Ok{};
  SessionOptions session;
  session.workers = workers;
  session.stop_requested = StopSignal::Requested;
  const StopSignal handlers;
  TRY(CampaignDirectory::IsCampaign(call.directory)
          ? context.campaigns.Resume(call.directory, session)
          : context.campaigns.Start(call.directory, call.searches, session));
  return Ok{};
}

}  // namespace

void LookAtEmptyArena(CommandContext& context, const std::string& directory, int workers) {
  if (!CampaignDirectory::IsCampaign(directory)) return;
  const Status looked = Look(context, directory, workers);
  if (!looked && !StopSignal::Requested())
    PrintMessage(context, "nobody has looked at the arena without obstacles: " + looked.error().message);
}

}  // namespace gauntlet
