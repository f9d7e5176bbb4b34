// gauntlet submit: a campaign whose master and workers are jobs of a Slurm cluster.

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "master/cli/commands.h"
#include "master/cli/submitted_campaign.h"
#include "master/cli/sweep.h"
#include "master/cli/table.h"
#include "master/experiment/experiment_file.h"
#include "master/search/search_table.h"
#include "master/session/bind_endpoint.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

// The user's file, the experiment's [slurm] table, then the command line.
Result<SlurmSettings> ReadSettings(const SubmitOptions& options, const Experiment& experiment) {
  std::vector<SlurmSource> sources;
  if (const std::string file = UserSlurmFile(); !file.empty()) {
    const Result<std::string> text = ReadSmallFile(file);
    if (text) sources.push_back({*text, file, true});
    if (!text && text.error().kind != ErrorKind::kNotFound) return text.error();
  }
  const Result<ExperimentText> source = ReadExperimentText(options.common.experiment);
  if (!source) return source.error();
  sources.push_back({source->text, source->file_name, false});
  std::vector<std::string> sets = options.slurm;
  if (!options.master.empty()) sets.push_back("master=" + options.master);
  Result<SlurmSettings> settings = ReadSlurmSettings(sources, sets);
  if (!settings) return settings;
  const ListenOn where =
      settings->master == MasterPlace::kHere ? ListenOn::kThisMachine : ListenOn::kAnotherMachine;
  if (const Status possible = CheckBindEndpoint(settings->bind, where); !possible) return possible.error();
  if (settings->tag.empty()) settings->tag = DrawTag(experiment.name);
  for (std::string* path : {&settings->worker_template, &settings->master_template}) {
    std::error_code error;
    if (!path->empty()) *path = std::filesystem::absolute(*path, error).string();
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

}  // namespace

ExitCode RunSubmit(CommandContext& context, const SubmitOptions& options) {
  const CommonOptions& common = options.common;
  const Result<std::vector<SearchPlan>> searches = PlanSearches(common, options.sweeps, options.seeds);
  if (!searches) return Fail(context, searches.error());
  const Experiment& experiment = searches->front().experiment;
  for (const SearchPlan& search : *searches) {
    if (RowOf(search.experiment).given_cases)
      return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  const Result<SlurmSettings> settings = ReadSettings(options, experiment);
  if (!settings) return Fail(context, settings.error());
  const Result<std::string> directory = NewDirectory(common, experiment);
  if (!directory) return Fail(context, directory.error());
  const Result<SlurmCampaign> campaign = SlurmCampaign::Make(*settings, *directory);
  if (!campaign) return Fail(context, campaign.error());

  const bool as_job = settings->master == MasterPlace::kJob;
  std::vector<PlannedJob> jobs = {{"a job of workers", campaign->worker_script()}};
  if (as_job) jobs.insert(jobs.begin(), {"the master's job", campaign->master_script()});
  const Status possible = Test(context, *context.slurm(), jobs, options.dry_run);
  if (!possible) return Fail(context, possible.error());
  if (options.dry_run) return kExitDone;

  if (!as_job) {
    if (const Status free = TryToListen(settings->bind); !free) return Fail(context, free.error());
  }
  const Status prepared = context.service.prepare(*directory, *searches, WriteSlurmSettings(*settings));
  if (!prepared) return Fail(context, prepared.error());
  if (!as_job) {
    if (!common.quiet)
      PrintMessage(context, fmt::format("{}: workers come from Slurm as {}w*; see: {} status {}", *directory,
                                        campaign->job_prefix(), context.program, ShellQuoted(*directory)));
    return ServeSubmitted(context, common, *directory, *campaign, "");
  }
  const Result<std::string> job = SubmitMasterJob(context, *directory, *campaign);
  if (!job) return Fail(context, job.error());
  if (common.json) {
    context.out << JsonText({{"directory", *directory}, {"job", *job}});
  } else {
    const std::string place = ShellQuoted(*directory);
    context.out << fmt::format(
        "{0}: job {1} is the master; its workers will be {2}w*\n\n  {3} status {4}\n  {3} stop {4}\n",
        *directory, *job, campaign->job_prefix(), context.program, place);
  }
  context.out << std::flush;
  return kExitDone;
}

}  // namespace gauntlet::master
