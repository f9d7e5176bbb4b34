#include "cli/stream_run.h"

#include <unistd.h>

#include <ctime>
#include <optional>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "cli/run_campaign.h"
#include "master/directory/campaign_directory.h"
#include "master/session/bind_endpoint.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/streams/evaluation_pipe.h"

namespace gauntlet {
namespace {

// The campaign there is one of such lines.
Status CheckSame(const std::string& directory, const Experiment& here) {
  TRY(const CampaignDirectory campaign, CampaignDirectory::Open(directory));
  TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(campaign));
  const Experiment& there = plans.front().experiment;
  if (!RowOf(there).streamed)
    return InvalidInput(fmt::format("{} holds another search ({}) and no stream of cases: give another --dir",
                                    directory, RowOf(there).title));
  for (const Key& key : AllKeysOf(there)) {
    if (key.for_people) continue;
    const KeyValue was = key.get(there);
    const KeyValue is = key.get(here);
    if (was == is) continue;
    return InvalidInput(
        fmt::format("{} was begun with {} = {}, here it is {}: the same command goes on, for another "
                    "experiment give another --dir",
                    directory, key.path, ToToml(was), ToToml(is)));
  }
  if (there.plugin == here.plugin && there.scenario_plugin == here.scenario_plugin &&
      there.definition == here.definition)
    return Ok{};
  return InvalidInput(
      fmt::format("{} was begun with another plug-in or definition: give another --dir", directory));
}

}  // namespace

Result<ExitCode> RunStream(CommandContext& context, const LocalOptions& options,
                           const std::vector<ExtraSet>& extra) {
  TRY(const Experiment experiment, LoadExperimentWith(options.experiment, extra));
  const std::string& wanted = options.experiment.directory;
  const std::string directory =
      wanted.empty() ? DefaultDirectory(experiment.name, std::time(nullptr)) : wanted;
  const bool exists = CampaignDirectory::IsCampaign(directory);
  if (exists) {
    TRY(CheckSame(directory, experiment));
  }
  CampaignRun run;
  run.directory = directory;
  TRY(UseWorkers(context, options.running, experiment, {.experiment_file = options.experiment.experiment},
                 run));
  if (!exists) {
    if (run.jobs) {
      TRY(TryToListen(run.jobs->settings().bind));
    }
    TRY(context.campaigns.Prepare(directory, {{"", experiment}}, run.session.slurm));
  }
  EvaluationPipe pipe(experiment, directory, {STDIN_FILENO, STDOUT_FILENO});
  run.goes_on_by = fmt::format("evaluate {} --stdin --dir {}, and the other options of this call",
                               ShellQuoted(options.experiment.experiment), PastedPath(directory));
  run.announcement = fmt::format("{}: cases from stdin, {}, seed {}, in {}", experiment.name,
                                 run.WorkersText(), experiment.seed, directory);
  run.serving = options.running;
  run.session.feed = &pipe;
  run.run = [&](const SessionOptions& session) { return context.campaigns.Resume(directory, session); };
  run.report = [&](const SessionReport& report) -> Status {
    if (!options.running.quiet)
      PrintMessage(
          context,
          fmt::format("{} answered, {} stored; see: {} show {}", Counted(pipe.lines(), "line"),
                      Counted(report.summary.runs_done, "run"), context.program, PastedPath(directory)));
    return Ok{};
  };
  return RunCampaign(context, run);
}

}  // namespace gauntlet
