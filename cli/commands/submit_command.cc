// gauntlet submit: a campaign whose master and workers are jobs of a cluster.

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/options/sweep.h"
#include "cli/submitted_campaign.h"
#include "master/campaign/forecast.h"
#include "master/session/bind_endpoint.h"
#include "proto/json_text.h"
#include "search/experiment/experiment_file.h"

namespace gauntlet {
namespace {

struct SubmitOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  MessageOptions messages;
  SweepOptions sweep;
  SlurmOptions slurm;
  bool dry_run = false;
};

// Hands the master's job to the cluster and says how to follow it.
Result<ExitCode> SubmitAndReturn(CommandContext& context, const SubmitOptions& options,
                                 const std::string& directory, const slurm::SlurmCampaign& campaign) {
  TRY(const std::string job, SubmitMasterJob(context, directory, campaign));
  if (options.messages.json) {
    context.out << JsonText({{"directory", directory}, {"job", job}});
  } else {
    context.out << fmt::format(
        "{0}: job {1} is the master; its workers will be {2}w*\n\n  {3} status {4}\n  {3} stop {4}\n",
        directory, job, campaign.job_prefix(), context.program, PastedPath(directory));
  }
  context.out << std::flush;
  return kExitDone;
}

// What the jobs come to, as a comment behind their scripts.
Result<ExitCode> PrintCost(CommandContext& context, const std::vector<SearchPlan>& searches,
                           const slurm::PoolLimits& pool) {
  TRY(const Forecast forecast, MakeForecast(searches));
  const int workers = pool.max_allocations * pool.workers_per_allocation;
  context.out << fmt::format(
                     "\n# {} runs, about {:.2g} core hours on cores like this machine's; at most {} of {}, "
                     "with which they take "
                     "about {}\n",
                     FormatCount(forecast.runs), forecast.Seconds(1) / 3600.0,
                     Counted(pool.max_allocations, "allocation"),
                     Counted(pool.workers_per_allocation, "worker"),
                     FormatDuration(forecast.Seconds(workers)))
              << std::flush;
  return kExitDone;
}

Result<ExitCode> RunSubmit(CommandContext& context, const SubmitOptions& options) {
  TRY(const std::vector<SearchPlan> searches,
      PlanSearches(options.experiment, SetsOf(options.size), options.sweep));
  if (!options.messages.quiet) TellOfIdleSettings(context, searches);
  const Experiment& experiment = searches.front().experiment;
  TRY(const ExperimentText text, ReadExperimentText(options.experiment.experiment));
  TRY(slurm::SlurmSettings settings,
      ReadSlurmOptions(options.slurm, slurm::SlurmSource{text.text, text.file_name, false}, experiment.name));
  TRY(AskForCores(experiment, settings));
  TRY(const std::string directory, NewDirectory(options.experiment.directory, experiment));
  TRY(const slurm::SlurmCampaign campaign, slurm::SlurmCampaign::Make(settings, directory));

  TRY(TestJobs(context, campaign, options.dry_run));
  if (options.dry_run) return PrintCost(context, searches, campaign.limits());
  const bool as_job = settings.master == slurm::MasterPlace::kJob;
  if (!as_job) {
    TRY(TryToListen(settings.bind));
  }
  TRY(context.campaigns.Prepare(directory, searches, slurm::WriteSlurmSettings(settings)));
  if (as_job) return SubmitAndReturn(context, options, directory, campaign);
  if (!options.messages.quiet)
    PrintMessage(context, fmt::format("{}: workers come from {} as {}w*; see: {} status {}", directory,
                                      campaign.cluster().name, campaign.job_prefix(), context.program,
                                      PastedPath(directory)));
  return ServeSubmitted(context, {options.messages, "", ""}, directory, campaign, "");
}

}  // namespace

void AddSubmit(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "submit", "run a search as jobs of a cluster: Slurm, SGE, PBS, or hosts with ssh", RunSubmit);
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddMessageOptions(command, options.messages);
  AddSlurmOptions(command, options.slurm);
  AddSweepOptions(command, options.sweep);
  command.add_flag("--dry-run", options.dry_run,
                   "submit nothing: print the job scripts, what the scheduler says of them, and how "
                   "many runs, core hours and "
                   "allocations it would take");
  std::string settings;
  for (const slurm::SlurmKey& key : slurm::SlurmKeys()) {
    const std::string value = ToSet(key.default_value);
    settings += fmt::format("  {:24}{}{}\n", key.path, key.description,
                            value.empty() ? "" : fmt::format(" (default {})", value));
  }
  command.footer(
      R"(Submits the master as a job and returns. While there is work, the master submits workers and replaces lost
ones; when the search has ended, it cancels them. The campaign's directory must be on a file system that the
compute nodes share. The cluster is Slurm's unless --slurm cluster=sge, cluster=pbs or a cluster file says
otherwise (docs/clusters.md). The same experiment and seed give the same result as with 'evolve'.

With --sweep or --seeds the campaign holds many searches, which share one pool of workers. Each search gives the
same result as 'evolve' with its --set and --seed; 'show' lists them.

Settings for --slurm, which may also be in the experiment's [slurm] table or in ~/.config/gauntlet/slurm.toml:
)" + settings +
      R"(
Examples:
  gauntlet submit flocking --dir $WORK/flocking-1 --slurm partition=short --slurm max_allocations=20
  gauntlet submit flocking --dry-run
  gauntlet submit flocking --dir $HOME/flocking-1 --slurm cluster=sge
  gauntlet submit flocking --sweep search.mutation_probability=0.02,0.05,0.1 --seeds 1..20
  gauntlet submit flocking --master here --generations 100)");
}

}  // namespace gauntlet
