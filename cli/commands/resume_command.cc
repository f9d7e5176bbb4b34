// gauntlet resume: go on with a campaign.
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/options/stop_signal.h"
#include "cli/run_campaign.h"
#include "cli/study_run.h"
#include "cli/submitted_campaign.h"
#include "study/questions/baselines.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

struct ResumeOptions {
  std::string directory;
  std::string generations;
  std::vector<std::string> sets;
  RunningOptions running;
  BindOptions bind;
  bool as_job = false;
};

// Makes the campaign longer, if that is wanted.
Status Extend(CommandContext& context, const ResumeOptions& options) {
  std::vector<ExtraSet> extra;
  if (!options.generations.empty())
    extra.push_back({"--generations", "search.generations", options.generations});
  TRY(const std::vector<std::string> sets, JoinSets(options.sets, extra));
  if (sets.empty()) return Ok{};
  const Result<std::string> change = context.campaigns.Extend(options.directory, sets, StopSignal::Requested);
  if (!change) return AsTyped(change.error(), extra);
  if (options.running.quiet) return Ok{};
  PrintMessage(context, change->empty() ? fmt::format("{} is that long already", options.directory)
                                        : fmt::format("{} goes on: {}", options.directory, *change));
  return Ok{};
}

Status CheckNoMasterJob(CommandContext& context, const std::string& directory,
                        const slurm::SlurmCampaign& campaign) {
  TRY(const std::vector<slurm::JobStatus> jobs, campaign.LivingJobs(*ClientOf(context, campaign)));
  for (const slurm::JobStatus& job : jobs) {
    if (job.name != campaign.master_job_name()) continue;
    return Error{ErrorKind::kInUse,
                 fmt::format("job {} ({}) is the campaign's master already; see: {} status {}", job.id,
                             job.state, context.program, PastedPath(directory))};
  }
  return Ok{};
}

std::string JobOfThisProcess() {
  for (const char* name : {"GAUNTLET_BATCH_JOB", "SLURM_JOB_ID"}) {
    if (const char* job = std::getenv(name); job != nullptr) return job;
  }
  return "unknown";
}

// The master's job of a submitted campaign, handed to its cluster again unless it is there.
Result<ExitCode> SubmitAgain(CommandContext& context, const ResumeOptions& options,
                             const slurm::SlurmCampaign& campaign) {
  const std::string& directory = options.directory;
  TRY(const CampaignSummary summary, context.campaigns.Read(directory));
  if (summary.finished) {
    TRY(PrintFinished(context, summary, directory, options.running));
    return kExitDone;
  }
  TRY(CheckNoMasterJob(context, directory, campaign));
  TRY(const std::string job, SubmitMasterJob(context, directory, campaign));
  context.out << fmt::format("{} goes on as job {}\n", directory, job) << std::flush;
  return kExitDone;
}

Result<ExitCode> ResumeSubmitted(CommandContext& context, const ResumeOptions& options,
                                 const slurm::SlurmCampaign& campaign) {
  const Status extended = [&] {
    const StopSignal handlers;
    return Extend(context, options);
  }();
  if (StopSignal::Requested()) {
    PrintMessage(context, extended.ok()
                              ? fmt::format("{} was told to stop before it went on", options.directory)
                              : extended.error().message);
    return kExitStopped;
  }
  TRY(extended);
  if (options.as_job)
    return ServeSubmitted(context, options.running, options.directory, campaign, JobOfThisProcess());
  if (campaign.settings().master == slurm::MasterPlace::kHere)
    return ServeSubmitted(context, options.running, options.directory, campaign, "");
  return SubmitAgain(context, options, campaign);
}

// Whether nothing is left to be simulated.
Result<bool> IsSimulated(const Study& study, const std::string& directory) {
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    TRY(const StageState state, LookAtStage(study, directory, stage));
    if (!state.finished) return false;
  }
  return true;
}

// A study's directory holds campaigns, of a length that its file says.
Result<ExitCode> ResumeStudy(CommandContext& context, const ResumeOptions& options) {
  const std::string& directory = options.directory;
  if (!options.generations.empty() || !options.sets.empty() || !options.bind.endpoint.empty() ||
      !options.running.slurm.empty()) {
    return InvalidInput(
        fmt::format("{} holds a study: its file says how long its searches are, and "
                    "its workers are of this machine or of a cluster",
                    directory));
  }
  TRY(const Study study, OpenStudy(directory));
  TRY(const std::optional<slurm::SlurmCampaign> submitted, slurm::SlurmCampaign::Find(directory));
  if (!submitted.has_value() && options.as_job)
    return InvalidInput(fmt::format("--as-job: {} was not submitted", directory));
  TRY(const bool simulated, IsSimulated(study, directory));
  StudyRun run{directory, options.running, "", nullptr, ""};
  if (!submitted.has_value() || !options.running.workers.empty() || simulated)
    return RunStudyIn(context, study, run);
  run.submitted = &*submitted;
  if (options.as_job) {
    run.batch_job = JobOfThisProcess();
    return RunStudyIn(context, study, run);
  }
  if (submitted->settings().master == slurm::MasterPlace::kHere) return RunStudyIn(context, study, run);
  TRY(CheckNoMasterJob(context, directory, *submitted));
  return SubmitStudyJob(context, directory, *submitted, options.running.json);
}

Result<ExitCode> RunResume(CommandContext& context, const ResumeOptions& options) {
  if (IsStudy(options.directory)) return ResumeStudy(context, options);
  const bool bound = !options.bind.endpoint.empty();
  if (!bound && options.running.workers.empty()) {
    TRY(const std::optional<slurm::SlurmCampaign> submitted, slurm::SlurmCampaign::Find(options.directory));
    if (submitted && options.running.slurm.empty()) return ResumeSubmitted(context, options, *submitted);
    if (submitted && submitted->settings().master == slurm::MasterPlace::kJob)
      return InvalidInput(
          fmt::format("--slurm: the master of {0} is a job, which reads {0}/slurm.toml", options.directory));
  }
  if (options.as_job)
    return InvalidInput(
        fmt::format("--as-job: {} was not submitted, or --workers or --bind "
                    "is given; use 'submit'",
                    options.directory));
  // With --bind workers come from elsewhere, unless some are asked for.
  const bool none = bound && options.running.workers.empty();
  CampaignRun campaign;
  campaign.directory = options.directory;
  if (!options.running.slurm.empty()) {
    if (bound) return InvalidInput("--slurm goes without --bind: give --slurm bind=ENDPOINT");
    TRY(const CampaignDirectory directory, CampaignDirectory::Open(options.directory));
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(directory));
    TRY(UseWorkers(context, options.running, plans.front().experiment, {}, campaign));
  } else {
    TRY(campaign.session.workers, none ? Result<int>(0) : ParseWorkers(options.running.workers));
  }
  campaign.serving = options.running;
  campaign.bind = options.bind;
  campaign.run = [&](const SessionOptions& session) -> Result<SessionReport> {
    TRY(Extend(context, options));
    Result<SessionReport> report = context.campaigns.Resume(options.directory, session);
    campaign.looks_at_empty_arena = report && HasBaseline(report->summary.searches.front().search);
    return report;
  };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddResume(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("resume", "continue a campaign that was stopped or killed", RunResume);
  AddDirectory(command, options.directory);
  AddValue(command, "--generations", "G", options.generations, "short for --set search.generations=G");
  AddValue(command, "--set", "KEY=VALUE", options.sets,
           "make the campaign longer: a greater value of the key that sets the length of its search "
           "(search.generations, search.cases, search.runs)");
  AddRunningOptions(command, options.running);
  AddJobsOption(command, options.running);
  AddBindOptions(command, options.bind);
  command.add_flag(
      "--as-job", options.as_job,
      "for the master's job of a submitted campaign: replace a second master of it, and leave the workers to "
      "the next one");
  command.footer(
      R"(Continues the campaign where it ended, whatever ended it. No finished run is simulated again, and the result
is that of an undisturbed campaign. Of a finished campaign only the summary is printed, unless --generations or
--set makes it longer: its result is then that of a campaign that had this length from the start. In a sweep,
all searches get the new length.

With --bind, workers connect from elsewhere, as with 'gauntlet master'. A campaign that was submitted to a cluster
continues there, and its remaining jobs are used, unless --workers or --bind is given.

Examples:
  gauntlet resume campaigns/flocking-20260131T120000Z --workers 4
  gauntlet resume DIR --generations 80
  gauntlet resume DIR --bind 'tcp://0.0.0.0:*')");
}

}  // namespace gauntlet
