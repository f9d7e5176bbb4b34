// gauntlet submit: a campaign whose master and workers are jobs of a Slurm cluster.

#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "master/cli/commands.h"
#include "master/cli/options.h"
#include "master/cli/submitted_campaign.h"
#include "master/cli/sweep.h"
#include "master/experiment/experiment_file.h"
#include "master/session/bind_endpoint.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

struct SubmitOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  MessageOptions messages;
  SweepOptions sweep;
  std::string master;              // "job" or "here"; "" = as the settings say
  std::vector<std::string> slurm;  // "key=value"
  bool dry_run = false;
};

// The user's file, the experiment's [slurm] table, then the command line.
Result<slurm::SlurmSettings> ReadSettings(const SubmitOptions& options, const Experiment& experiment) {
  std::vector<slurm::SlurmSource> sources;
  if (const std::string file = slurm::UserSlurmFile(); !file.empty()) {
    const Result<std::string> text = ReadSmallFile(file);
    if (text) sources.push_back({*text, file, true});
    if (!text && text.error().kind != ErrorKind::kNotFound) return text.error();
  }
  const Result<ExperimentText> source = ReadExperimentText(options.experiment.experiment);
  if (!source) return source.error();
  sources.push_back({source->text, source->file_name, false});
  std::vector<std::string> sets = options.slurm;
  if (!options.master.empty()) sets.push_back("master=" + options.master);
  Result<slurm::SlurmSettings> settings = slurm::ReadSlurmSettings(sources, sets);
  if (!settings) return settings;
  const ListenOn where =
      settings->master == slurm::MasterPlace::kHere ? ListenOn::kThisMachine : ListenOn::kAnotherMachine;
  if (const Status possible = CheckBindEndpoint(settings->bind, where); !possible) return possible.error();
  if (settings->tag.empty()) settings->tag = slurm::DrawTag(experiment.name);
  for (std::string* path : {&settings->worker_template, &settings->master_template}) {
    if (path->empty()) continue;
    // Links are followed now, by whoever names the file; what the campaign keeps leads to the file itself.
    std::error_code error;
    const std::filesystem::path file = std::filesystem::weakly_canonical(*path, error);
    *path = error ? std::filesystem::absolute(*path, error).string() : file.string();
  }
  return settings;
}

struct PlannedJob {
  std::string what;
  std::string script;
};

// Asks Slurm of each job whether it could ever start; with --dry-run prints scripts and answers. Error: the
// first that could not.
Status Test(CommandContext& context, slurm::SlurmClient& client, const std::vector<PlannedJob>& jobs,
            bool print) {
  Status outcome = Ok{};
  for (const PlannedJob& job : jobs) {
    if (!outcome && !print) break;
    const Result<std::string> answer = client.TestOnly(job.script, {});
    const std::string words = answer ? *answer : answer.error().message;
    if (print)
      context.out << fmt::format("# {}\n{}\n# sbatch --test-only: {}\n\n", job.what, job.script, words);
    if (!answer && outcome) {
      outcome = Error{answer.error().kind,
                      fmt::format("{} could not start: {}{}", job.what, words, slurm::NextStep(words))};
    }
  }
  context.out << std::flush;
  return outcome;
}

// Hands the master's job to Slurm and says how to follow it.
ExitCode SubmitAndReturn(CommandContext& context, const SubmitOptions& options, const std::string& directory,
                         const slurm::SlurmCampaign& campaign) {
  const Result<std::string> job = SubmitMasterJob(context, directory, campaign);
  if (!job) return Fail(context, job.error());
  if (options.messages.json) {
    context.out << JsonText({{"directory", directory}, {"job", *job}});
  } else {
    context.out << fmt::format(
        "{0}: job {1} is the master; its workers will be {2}w*\n\n  {3} status {4}\n  {3} stop {4}\n",
        directory, *job, campaign.job_prefix(), context.program, PastedPath(directory));
  }
  context.out << std::flush;
  return kExitDone;
}

ExitCode RunSubmit(CommandContext& context, const SubmitOptions& options) {
  const Result<std::vector<SearchPlan>> searches =
      PlanSearches(options.experiment, SetsOf(options.size), options.sweep);
  if (!searches) return Fail(context, searches.error());
  const Experiment& experiment = searches->front().experiment;
  const Result<slurm::SlurmSettings> settings = ReadSettings(options, experiment);
  if (!settings) return Fail(context, settings.error());
  const Result<std::string> directory = NewDirectory(options.experiment.directory, experiment);
  if (!directory) return Fail(context, directory.error());
  const Result<slurm::SlurmCampaign> campaign = slurm::SlurmCampaign::Make(*settings, *directory);
  if (!campaign) return Fail(context, campaign.error());

  const bool as_job = settings->master == slurm::MasterPlace::kJob;
  std::vector<PlannedJob> jobs = {{"a job of workers", campaign->worker_script()}};
  if (as_job) jobs.insert(jobs.begin(), {"the master's job", campaign->master_script()});
  const Status possible = Test(context, *context.slurm(), jobs, options.dry_run);
  if (!possible) return Fail(context, possible.error());
  if (options.dry_run) return kExitDone;

  if (!as_job) {
    if (const Status free = TryToListen(settings->bind); !free) return Fail(context, free.error());
  }
  const Status prepared =
      context.campaigns.Prepare(*directory, *searches, slurm::WriteSlurmSettings(*settings));
  if (!prepared) return Fail(context, prepared.error());
  if (as_job) return SubmitAndReturn(context, options, *directory, *campaign);
  if (!options.messages.quiet)
    PrintMessage(context, fmt::format("{}: workers come from Slurm as {}w*; see: {} status {}", *directory,
                                      campaign->job_prefix(), context.program, PastedPath(*directory)));
  return ServeSubmitted(context, {options.messages, "", ""}, *directory, *campaign, "");
}

}  // namespace

void AddSubmit(CommandParser& parser) {
  const auto [command, options] = parser.Add("submit", "a search as jobs of a Slurm cluster", RunSubmit);
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddMessageOptions(command, options.messages);
  AddValue(command, "--master", "job|here", options.master,
           "job (default): the master is a job too; here: it runs in this process")
      ->check(CLI::IsMember({"job", "here"}));
  AddValue(command, "--slurm", "KEY=VALUE", options.slurm,
           "one setting of the jobs or the pool, e.g. --slurm partition=short; repeatable");
  AddSweepOptions(command, options.sweep);
  command.add_flag("--dry-run", options.dry_run,
                   "submit nothing: print the scripts and what sbatch --test-only says of them");
  std::string settings;
  for (const slurm::SlurmKeyInfo& key : slurm::SlurmKeys()) {
    settings += fmt::format("  {:24}{}{}\n", key.name, key.description,
                            key.default_value.empty() ? "" : fmt::format(" (default {})", key.default_value));
  }
  command.footer(
      R"(Submits the master as a job and returns; the master submits workers as there is work for them, replaces those
that are lost, and cancels them when the search has ended. The campaign's directory must be on a file system
that the compute nodes share. Same experiment and seed: same result as with 'evolve'.

With --sweep and --seeds the campaign holds many searches, which share one pool; each ends like 'evolve' with its
--set and --seed. 'show' tells them apart.

Settings for --slurm, also in the experiment's [slurm] table and in ~/.config/gauntlet/slurm.toml:
)" + settings +
      R"(
Examples:
  gauntlet submit flocking --dir $WORK/flocking-1 --slurm partition=short --slurm max_allocations=20
  gauntlet submit flocking --dry-run
  gauntlet submit flocking --sweep search.mutation_probability=0.02,0.05,0.1 --seeds 1..20
  gauntlet submit flocking --master here --generations 100)");
}

}  // namespace gauntlet::master
