#include "slurm/slurm_campaign.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <random>
#include <utility>

#include "base/hash.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/program_path.h"
#include "base/system/regular_file.h"
#include "base/system/trusted_path.h"
#include "slurm/slurm_pool.h"
#include "slurm/ssh_hosts.h"

namespace gauntlet::slurm {
namespace {

constexpr std::size_t kMostTemplateBytes = 1 << 20;
constexpr const char* kSettingsFile = "slurm.toml";

bool MayStandInAJobName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
}

std::string AsJobName(std::string text) {
  for (char& c : text) {
    if (!MayStandInAJobName(c)) c = '-';
  }
  return text;
}

Result<std::string> Template(const std::string& path, std::string_view shipped, std::string_view key) {
  if (path.empty()) return std::string(shipped);
  Result<std::string> text = ReadRegularFile(path, kMostTemplateBytes);
  if (!text) return InvalidInput(fmt::format("slurm.{}: {}", key, text.error().message));
  return text;
}

}  // namespace

std::string DrawTag(const std::string& experiment_name) {
  std::random_device device;
  return fmt::format("{}-{:08x}", AsJobName(experiment_name), device());
}

SlurmCampaign::SlurmCampaign(SlurmSettings settings, std::string directory)
    : settings_(std::move(settings)), directory_(std::move(directory)) {
  Fnv1a64 hash;
  hash.AddBytes(directory_);
  job_prefix_ = fmt::format("gauntlet-{}-{:06x}-", AsJobName(settings_.tag), hash.value() & 0xffffff);
}

Result<SlurmCampaign> SlurmCampaign::Make(const SlurmSettings& settings, const std::string& directory) {
  std::error_code error;
  std::filesystem::path absolute = std::filesystem::absolute(directory, error);
  if (!error) absolute = std::filesystem::weakly_canonical(absolute, error);
  if (error) return SystemError(fmt::format("cannot find {}", directory), error.value());
  SlurmCampaign campaign(settings, absolute.string());
  TRY(campaign.cluster_, FindCluster(settings.cluster));
  TRY(campaign.MakeScripts());
  return campaign;
}

Result<std::optional<SlurmCampaign>> SlurmCampaign::Find(const std::string& directory) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(directory, ignored)) return std::optional<SlurmCampaign>();
  const std::string path = directory + "/" + kSettingsFile;
  const Result<std::string> text = ReadRegularFile(path);
  if (!text && text.error().kind == ErrorKind::kNotFound) return std::optional<SlurmCampaign>();
  if (!text) return text.error();
  const std::array<std::string_view, 1> obeyed = {kSettingsFile};
  TRY(CheckOnlyWeWrite(directory, obeyed));
  TRY(const auto settings, ReadSlurmSettings({{*text, path, true}}, {}));
  TRY(auto campaign, Make(settings, directory));
  return std::optional(std::move(campaign));
}

WorkerJob SlurmCampaign::WorkersJob() const {
  return {.name = job_prefix_ + "w",
          .worker =
              settings_.worker_command.empty() ? ShellQuoted(WorkerProgramPath()) : settings_.worker_command,
          .access_file = directory_ + "/access.json",
          .log_directory = directory_ + "/log",
          .slots = settings_.pool.workers_per_allocation};
}

Status SlurmCampaign::MakeScripts() {
  const bool of_slurm = cluster_.script == kSlurmScripts;
  const std::string_view script = cluster_.script;
  TRY(worker_template_,
      Template(settings_.worker_template, of_slurm ? kWorkerTemplate : script, "worker_template"));
  TRY(worker_script_, WorkerScript(worker_template_, WorkersJob(), settings_.worker_job, cluster_));

  TRY(const auto master_template,
      Template(settings_.master_template, of_slurm ? kMasterTemplate : script, "master_template"));
  // Of what the workers ask for, the master needs the account and the software.
  JobRequest request;
  request.account = settings_.worker_job.account;
  request.qos = settings_.worker_job.qos;
  request.setup = settings_.worker_job.setup;
  request.partition =
      settings_.master_partition.empty() ? settings_.worker_job.partition : settings_.master_partition;
  request.time_limit = settings_.master_time_limit;
  TRY(master_script_,
      MasterScript(master_template,
                   {.name = master_job_name(),
                    .command = {MasterProgramPath(), "resume", directory_, "--as-job", "--no-progress"},
                    .log_directory = directory_ + "/log"},
                   request, cluster_));
  return Ok{};
}

PoolLimits SlurmCampaign::limits() const {
  PoolLimits limits = settings_.pool;
  if (cluster_.hosts.empty()) return limits;
  // Nothing waits there, and more than there is room for would only be refused.
  const int room = SshHosts(cluster_, limits.workers_per_allocation).room();
  limits.max_allocations = limits.max_queued = std::min(limits.max_allocations, room);
  return limits;
}

std::unique_ptr<WorkerPool> SlurmCampaign::MakePool(std::unique_ptr<SlurmClient> client) const {
  SlurmPoolOptions options;
  options.limits = limits();
  options.cluster = cluster_;
  options.request = settings_.worker_job;
  options.job_template = worker_template_;
  options.job = WorkersJob();
  return std::make_unique<SlurmPool>(std::move(options), std::move(client));
}

std::unique_ptr<SlurmClient> SlurmCampaign::MakeClient() const {
  if (!cluster_.hosts.empty())
    return std::make_unique<SshHosts>(cluster_, settings_.pool.workers_per_allocation);
  return std::make_unique<CommandLineSlurm>(cluster_);
}

Result<std::vector<JobStatus>> SlurmCampaign::LivingJobs(SlurmClient& client) const {
  Result<std::vector<JobStatus>> jobs = client.Queue(job_prefix_);
  if (jobs) std::erase_if(*jobs, [](const JobStatus& job) { return job.phase == JobPhase::kEnded; });
  return jobs;
}

Result<std::vector<std::string>> SlurmCampaign::CancelJobs(SlurmClient& client) const {
  TRY(const auto jobs, LivingJobs(client));
  std::vector<std::string> ids;
  for (const JobStatus& job : jobs) {
    if (job.phase != JobPhase::kEnding) ids.push_back(job.id);
  }
  TRY(client.Cancel(ids));
  return ids;
}

}  // namespace gauntlet::slurm
