// gauntlet resume, gauntlet show: a campaign that exists.
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {
namespace {

ExitCode Resume(CommandContext& context, const CommonOptions& options) {
  const Result<int> workers = ParseWorkers(options.workers);
  if (!workers) return Fail(context, workers.error());
  CampaignRun campaign;
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

ExitCode Show(CommandContext& context, const CommonOptions& options) {
  const Result<CampaignSummary> summary = context.service.read(options.directory);
  if (!summary) return Fail(context, summary.error());
  PrintSummary(context, *summary, options.directory, options.json);
  return kExitDone;
}

}  // namespace

void AddResumeCommand(CLI::App& app, CommandAction& chosen) {
  CLI::App* command = app.add_subcommand("resume", "go on with a campaign that was stopped or killed");
  const auto options = std::make_shared<CommonOptions>();
  command->add_option("DIR", options->directory, "directory of the campaign")->required();
  AddRunningOptions(*command, *options);
  command->footer(
      "\nGoes on where the campaign was, whatever ended it; no finished run is simulated again, and the "
      "result\n"
      "is the one of an undisturbed campaign. A finished campaign is only summarised.\n"
      "\n"
      "Example:\n"
      "  gauntlet resume campaigns/flocking-20260131T120000Z --workers 4");
  command->callback([options, &chosen] {
    chosen = [options](CommandContext& context) { return Resume(context, *options); };
  });
}

void AddShowCommand(CLI::App& app, CommandAction& chosen) {
  CLI::App* command = app.add_subcommand("show", "what came out of a campaign");
  const auto options = std::make_shared<CommonOptions>();
  command->add_option("DIR", options->directory, "directory of the campaign")->required();
  command->add_flag("--json", options->json, "everything as one JSON document");
  command->footer(
      "\nSums up what is stored: runs, fitness by generation, total failures, the toughest cases with a run "
      "to\n"
      "replay, and the state hash, which is equal for equal outcomes.\n"
      "\n"
      "Examples:\n"
      "  gauntlet show campaigns/flocking-20260131T120000Z\n"
      "  gauntlet show DIR --json | jq '.population[0].genome'");
  command->callback([options, &chosen] {
    chosen = [options](CommandContext& context) { return Show(context, *options); };
  });
}

}  // namespace gauntlet::master
