#include "cli/stream_run.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "cli/run_campaign.h"
#include "cli/submitted_campaign.h"
#include "master/directory/campaign_directory.h"
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

// What makes workers jobs; nothing where none are wanted.
Result<std::optional<slurm::SlurmCampaign>> JobsOf(const LocalOptions& options, SlurmOptions slurm,
                                                   const Experiment& experiment,
                                                   const std::string& directory) {
  if (slurm.settings.empty()) return std::optional<slurm::SlurmCampaign>();
  if (!options.running.workers.empty())
    return InvalidInput("--slurm goes without --workers: workers are jobs");
  TRY(std::optional<slurm::SlurmCampaign> before, slurm::SlurmCampaign::Find(directory));
  if (before) return before;
  slurm.master = "here";
  TRY(const ExperimentText text, ReadExperimentText(options.experiment.experiment));
  TRY(const slurm::SlurmSettings settings,
      ReadSlurmOptions(slurm, slurm::SlurmSource{text.text, text.file_name, false}, experiment.name));
  TRY(slurm::SlurmCampaign campaign, slurm::SlurmCampaign::Make(settings, directory));
  return std::optional(std::move(campaign));
}

}  // namespace

Result<ExitCode> RunStream(CommandContext& context, const LocalOptions& options, const SlurmOptions& slurm,
                           const std::vector<ExtraSet>& extra) {
  TRY(const Experiment experiment, LoadExperimentWith(options.experiment, extra));
  const std::string& wanted = options.experiment.directory;
  const std::string directory =
      wanted.empty() ? DefaultDirectory(experiment.name, std::time(nullptr)) : wanted;
  const bool exists = CampaignDirectory::IsCampaign(directory);
  if (exists) {
    TRY(CheckSame(directory, experiment));
  }
  TRY(const auto jobs, JobsOf(options, slurm, experiment, directory));
  TRY(const int workers, jobs ? Result<int>(0) : ParseWorkers(options.running.workers));
  if (!exists) {
    TRY(context.campaigns.Prepare(directory, {{"", experiment}},
                                  jobs ? slurm::WriteSlurmSettings(jobs->settings()) : ""));
  }
  EvaluationPipe pipe(experiment, directory, {STDIN_FILENO, STDOUT_FILENO});
  CampaignRun run;
  run.directory = directory;
  run.goes_on_by = fmt::format("evaluate {} --stdin --dir {}, and the other options of this call",
                               ShellQuoted(options.experiment.experiment), PastedPath(directory));
  run.announcement = fmt::format("{}: cases from stdin, {}, seed {}, in {}", experiment.name,
                                 jobs ? "workers from " + jobs->cluster().name : Counted(workers, "worker"),
                                 experiment.seed, directory);
  run.serving = options.running;
  run.session.workers = workers;
  run.session.feed = &pipe;
  if (jobs) {
    run.bind.endpoint = jobs->settings().bind;
    run.session.make_pool = [&] { return jobs->MakePool(ClientOf(context, *jobs)); };
  }
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
