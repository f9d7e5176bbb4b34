// gauntlet stop: ends a campaign's master, its workers and its jobs.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/options/stop_signal.h"
#include "slurm/slurm_campaign.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

struct StopOptions {
  std::string directory;
};

// What the cluster still has of a campaign without a master. False when it did not answer.
bool CancelLeftovers(CommandContext& context, const std::string& directory) {
  const Result<std::optional<slurm::SlurmCampaign>> submitted = slurm::SlurmCampaign::Find(directory);
  if (submitted && !submitted->has_value()) return true;
  const Result<std::vector<std::string>> cancelled =
      submitted ? (*submitted)->CancelJobs(*ClientOf(context, **submitted))
                : Result<std::vector<std::string>>(submitted.error());
  if (!cancelled) {
    PrintMessage(
        context,
        fmt::format("{}{}; jobs of the campaign may be left: try again", cancelled.error().message,
                    submitted ? slurm::NextStep(cancelled.error().message, (*submitted)->cluster()) : ""));
    return false;
  }
  if (!cancelled->empty())
    PrintMessage(context, fmt::format("cancelled {} {}", Plural(cancelled->size(), "job"),
                                      fmt::join(*cancelled, ", ")));
  return true;
}

// Of a study the campaign that has a master, if any; else the directory itself.
Result<std::string> ServedIn(CommandContext& context, const std::string& directory) {
  if (!IsStudy(directory)) return directory;
  std::string last = directory;
  for (const std::string& campaign : CampaignsIn(directory)) {
    TRY(const bool lives, context.campaigns.MasterLives(campaign));
    if (lives) return campaign;
    last = campaign;
  }
  return last;
}

// Returns when the master is gone.
Result<ExitCode> StopCampaign(CommandContext& context, const StopOptions& options) {
  constexpr int kPollMilliseconds = 100;
  TRY(bool lives, context.campaigns.MasterLives(options.directory));
  if (!lives) {
    PrintMessage(context, fmt::format("no master serves {}: there is nothing to stop", options.directory));
    return CancelLeftovers(context, options.directory) ? kExitDone : kExitUsage;
  }
  TRY(context.campaigns.RequestStop(options.directory));
  PrintMessage(context, "the master lets the runs that have begun end, then stops (Ctrl-C: wait no longer)");
  const StopSignal handlers(/*announced=*/false);  // ends this command, not the campaign
  while (lives) {
    if (StopSignal::ComesWithin(kPollMilliseconds)) return kExitDone;
    TRY(lives, context.campaigns.MasterLives(options.directory));
  }
  const bool clean = CancelLeftovers(context, options.directory);
  PrintMessage(context, "stopped");
  return clean ? kExitDone : kExitUsage;
}

Result<ExitCode> RunStop(CommandContext& context, const StopOptions& options) {
  TRY(const std::string served, ServedIn(context, options.directory));
  if (served == options.directory) return StopCampaign(context, options);
  const Result<ExitCode> stopped = StopCampaign(context, {served});
  const ExitCode code = stopped ? *stopped : Fail(context, stopped.error());
  // The master's job of a study belongs to the study.
  return CancelLeftovers(context, options.directory) ? code : kExitUsage;
}

}  // namespace

void AddStop(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("stop", "stop a campaign after the runs that have begun", RunStop);
  AddDirectory(command, options.directory);
  command.footer(
      R"(The master gives out no more runs. The runs that have begun end and are stored, the workers leave, and the
master ends (exit 3); then this command returns. It works from any machine that sees the directory. For a
submitted campaign it cancels the campaign's jobs, and no others.

Example:
  gauntlet stop DIR)");
}

}  // namespace gauntlet
