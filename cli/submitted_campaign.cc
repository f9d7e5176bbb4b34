#include "cli/submitted_campaign.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "cli/run_campaign.h"
#include "controllers/command/definition.h"
#include "master/directory/commands.h"
#include "master/session/bind_endpoint.h"

namespace gauntlet {

Result<slurm::SlurmSettings> ReadSlurmOptions(const SlurmOptions& options,
                                              const std::optional<slurm::SlurmSource>& file,
                                              const std::string& name) {
  std::vector<slurm::SlurmSource> sources;
  if (const std::string users = slurm::UserSlurmFile(); !users.empty()) {
    const Result<std::string> text = ReadSmallFile(users);
    if (text) sources.push_back({*text, users, true});
    if (!text && text.error().kind != ErrorKind::kNotFound) return text.error();
  }
  if (file) sources.push_back(*file);
  std::vector<std::string> sets = options.settings;
  if (!options.master.empty()) sets.push_back("master=" + options.master);
  TRY(slurm::SlurmSettings settings, slurm::ReadSlurmSettings(sources, sets));
  const ListenOn where =
      settings.master == slurm::MasterPlace::kHere ? ListenOn::kThisMachine : ListenOn::kAnotherMachine;
  TRY(CheckBindEndpoint(settings.bind, where));
  if (settings.tag.empty()) settings.tag = slurm::DrawTag(name);
  for (std::string* path : {&settings.worker_template, &settings.master_template, &settings.cluster}) {
    if (path->empty() || (path == &settings.cluster && !slurm::IsClusterFile(*path))) continue;
    // Links are followed now, by whoever names the file; what the campaign keeps leads to the file itself.
    std::error_code error;
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(*path, error);
    *path = error ? std::filesystem::absolute(*path, error).string() : canonical.string();
  }
  return settings;
}

Status AskForCores(const Experiment& experiment, slurm::SlurmSettings& settings) {
  if (experiment.scenario != controllers::command::kScenario) return Ok{};
  TRY(const controllers::command::Definition command, CommandOf(experiment.scenario_plugin));
  settings.pool.workers_per_allocation *= command.cores;
  return Ok{};
}

std::unique_ptr<slurm::SlurmClient> ClientOf(const CommandContext& context,
                                             const slurm::SlurmCampaign& campaign) {
  return context.slurm ? context.slurm() : campaign.MakeClient();
}

void UseJobs(const CommandContext& context, const slurm::SlurmCampaign& campaign, SessionOptions& session) {
  session.workers = 0;
  session.bind = campaign.settings().bind;
  session.make_pool = [&] { return campaign.MakePool(ClientOf(context, campaign)); };
}

Status TestJobs(CommandContext& context, const slurm::SlurmCampaign& campaign, bool print) {
  struct PlannedJob {
    std::string what;
    std::string script;
  };
  std::vector<PlannedJob> jobs = {{"a job of workers", campaign.worker_script()}};
  if (campaign.settings().master == slurm::MasterPlace::kJob)
    jobs.insert(jobs.begin(), {"the master's job", campaign.master_script()});
  const std::unique_ptr<slurm::SlurmClient> client = ClientOf(context, campaign);
  // "sbatch --test-only"
  const std::string& command = campaign.cluster().test;
  const std::string test = command.substr(0, command.find(" \"$@\""));
  Status outcome = Ok{};
  for (const PlannedJob& job : jobs) {
    if (!outcome && !print) break;
    const Result<std::string> answer = client->TestOnly(job.script, {});
    const std::string words = answer ? *answer : answer.error().message;
    if (print)
      context.out << fmt::format("# {}\n{}\n{}\n", job.what, job.script,
                                 words.empty() ? "" : fmt::format("# {}: {}\n", test, words));
    if (!answer && outcome) {
      outcome = Error{answer.error().kind, fmt::format("{} could not start: {}{}", job.what, words,
                                                       slurm::NextStep(words, campaign.cluster()))};
    }
  }
  context.out << std::flush;
  return outcome;
}

Result<ExitCode> ServeSubmitted(CommandContext& context, const ServingOptions& options,
                                const std::string& directory, const slurm::SlurmCampaign& campaign,
                                const std::string& batch_job) {
  CampaignRun run;
  run.directory = directory;
  run.serving = options;
  run.jobs = campaign;
  run.session.batch_job = batch_job;
  bool served = false;
  run.run = [&](const SessionOptions& session) {
    Result<SessionReport> report = context.campaigns.Resume(directory, session);
    served = report && (report->runs_this_session > 0 || !report->summary.finished);
    return report;
  };
  TRY(const ExitCode code, RunCampaign(context, run));
  // Of a master that was killed between its last result and its farewell.
  if (code == kExitDone && !served && batch_job.empty()) {
    const Result<std::vector<std::string>> cancelled = campaign.CancelJobs(*ClientOf(context, campaign));
    if (!cancelled) PrintMessage(context, cancelled.error().message);
  }
  return code;
}

Result<std::string> SubmitMasterJob(CommandContext& context, const std::string& directory,
                                    const slurm::SlurmCampaign& campaign) {
  TRY(MakeDirectory(directory + "/log"));  // no scheduler makes one
  Result<std::string> job = ClientOf(context, campaign)->Submit(campaign.master_script(), {});
  if (!job) {
    const std::string& words = job.error().message;
    return Error{job.error().kind, fmt::format("{}{}. The campaign is made; try again with: {} resume {}",
                                               words, slurm::NextStep(words, campaign.cluster()),
                                               context.program, PastedPath(directory))};
  }
  return job;
}

}  // namespace gauntlet
