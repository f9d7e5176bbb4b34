#include "slurm/slurm_client.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace gauntlet::slurm {
namespace {

// "sbatch: error: Batch job submission failed: Invalid account" without the lines' prefixes, in one line.
std::string WordsOf(const std::string& program, const std::string& text) {
  std::string words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (const std::string& prefix : {program + ": ", std::string("error: ")}) {
      if (line.starts_with(prefix)) line.erase(0, prefix.size());
    }
    if (!line.empty()) words += (words.empty() ? "" : "; ") + line;
  }
  return words.empty() ? "it gave no reason" : words;
}

// Without SLURM_* and SBATCH_*, for an enclosing job's settings would leak into what is submitted; except
// SLURM_CONF, which says which cluster is meant.
bool Inherits(std::string_view variable) {
  return variable.starts_with("SLURM_CONF=") ||
         !(variable.starts_with("SLURM_") || variable.starts_with("SBATCH_"));
}

Error Refusal(const std::string& command, const CallOutput& output) {
  const std::string program = ProgramOf(command);
  return {ErrorKind::kInvalidInput, program + " refused (exit code " + std::to_string(output.exit_code) +
                                        "): " + WordsOf(program, output.err + output.out)};
}

Error Silence(const std::string& command, const CallOutput& output) {
  const std::string program = ProgramOf(command);
  return {ErrorKind::kIo, program + ": " + WordsOf(program, output.err + output.out)};
}

// Whether the id that the queue shows is this job, or a task of it.
bool IsOf(const std::string& job, const std::string& id) {
  return id.starts_with(job) &&
         (id.size() == job.size() || std::isdigit(static_cast<unsigned char>(id[job.size()])) == 0);
}

// sbatch --test-only asks the controller twice: an absent one costs it 18 s (seen with 22.05).
constexpr int kTestOnlyCalls = 2;

struct Advice {
  std::string_view scheduler;
  std::string_view words;
  std::string_view step;
};
// Words of Slurm 22.05 to 23.11 (slurm_errno.c, squeue(1) "JOB REASON CODES").
constexpr std::array kAdvice = {
    Advice{"Slurm", "no sbatch",
           "run this on a login node of the cluster, or put Slurm's commands into PATH"},
    Advice{"Slurm", "nvalid account",
           "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)"},
    Advice{"Slurm", "InvalidAccount",
           "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)"},
    Advice{"Slurm", "nvalid partition", "choose another: --slurm partition=NAME (`sinfo -s` lists them)"},
    Advice{"Slurm", "nvalid qos", "choose another: --slurm qos=NAME (`sacctmgr show qos` lists them)"},
    Advice{"Slurm", "time limit is invalid",
           "ask for less: --slurm time_limit=HH:MM:SS (`sinfo -o '%P %l'` shows the limits)"},
    Advice{"Slurm", "PartitionTimeLimit",
           "ask for less: --slurm time_limit=HH:MM:SS (`sinfo -o '%P %l'` shows the limits)"},
    Advice{"Slurm", "nvalid feature", "correct --slurm constraint=FEATURES (`sinfo -o '%N %f'` lists them)"},
    Advice{"Slurm", "node configuration is not available",
           "no node has what is asked for: lower memory, workers_per_allocation or constraint (`sinfo -o '%P "
           "%c %m %f'`)"},
    Advice{"Slurm", "PartitionNodeLimit",
           "no node of the partition has what is asked for (`sinfo -o '%P %c %m %f'`)"},
    Advice{"Slurm", "PartitionConfig",
           "no node of the partition has what is asked for (`sinfo -o '%P %c %m %f'`)"},
    Advice{"Slurm", "BadConstraints", "no node has what is asked for: correct --slurm constraint=FEATURES"},
    Advice{"Slurm", "accounting/QOS policy",
           "a limit of the site: lower --slurm max_allocations and max_queued, or wait"},
    Advice{"Slurm", "SubmitJob",
           "a limit of the site: lower --slurm max_allocations and max_queued, or wait"},
    Advice{"Slurm", "temporarily unable to accept job",
           "the cluster's queue is full: wait, or lower --slurm max_queued"},
    Advice{"Slurm", "Resource temporarily unavailable", "the cluster's queue is full: try again later"},
    Advice{"Slurm", "contact slurm controller", "what runs goes on; `scontrol ping` says when it is back"},
    // Grid Engine 8.1.9, PBS, OpenSSH 9.2.
    Advice{"Grid Engine", "unknown queue",
           "choose another: --slurm partition=NAME (`qconf -sql` lists them)"},
    Advice{"Grid Engine", "parallel environment",
           "name yours in a cluster file: docs/sge.md (`qconf -spl` lists them)"},
    Advice{"Grid Engine", "variable SGE_ROOT", "load Grid Engine's settings first: its common/settings.sh"},
    Advice{"PBS", "Unknown queue", "choose another: --slurm partition=NAME (`qstat -Q` lists them)"},
    Advice{"ssh", "Host key verification failed", "log in by hand once, where ssh asks: ssh HOST"},
    Advice{"ssh", "Permission denied (", "`ssh HOST true` must work without a password: ssh-copy-id HOST"},
};

}  // namespace

std::string NextStep(std::string_view words, const Cluster& cluster) {
  for (const Advice& advice : kAdvice) {
    if (advice.scheduler == cluster.name && words.find(advice.words) != std::string_view::npos)
      return "; " + std::string(advice.step);
  }
  return "";
}

Result<CallOutput> CallCluster(const Cluster& cluster, const std::string& command,
                               const std::vector<std::string>& arguments, std::string_view input,
                               std::chrono::milliseconds deadline) {
  CallOptions options;
  options.deadline = deadline;
  options.inherits = Inherits;
  const std::string program = ProgramOf(command);
  std::vector<std::string> line = {"/bin/bash", "--norc", "-o", "pipefail", "-c", command, program};
  line.insert(line.end(), arguments.begin(), arguments.end());
  Result<CallOutput> output = CallProcess(line, input, options);
  const auto says = [&](const char* what) { return output->err.find(program + what) != std::string::npos; };
  constexpr int kNoSuchProgram = 127;
  if (!output || output->exit_code != kNoSuchProgram ||
      !(says(": command not found") || says(": No such file or directory")))
    return output;
  return Error{ErrorKind::kNotFound,
               "there is no " + program + " in PATH: is " + cluster.name + " installed on this machine?"};
}

Result<std::string> CommandLineSlurm::Submit(const std::string& script,
                                             const std::vector<std::string>& options) {
  TRY(const auto output, CallCluster(cluster_, cluster_.submit, options, script, deadline_));
  if (output.exit_code != 0) return Refusal(cluster_.submit, output);
  Result<std::string> job = ParseJobId(output.out, cluster_);
  if (job) submitted_.push_back(*job);
  return job;
}

Result<std::string> CommandLineSlurm::TestOnly(const std::string& script,
                                               const std::vector<std::string>& options) {
  if (cluster_.test.empty()) return std::string();
  TRY(const auto output, CallCluster(cluster_, cluster_.test, options, script, kTestOnlyCalls * deadline_));
  if (output.exit_code != 0) return Refusal(cluster_.test, output);
  return WordsOf(ProgramOf(cluster_.test), output.err + output.out);
}

Result<std::vector<JobStatus>> CommandLineSlurm::Queue(const std::string& name_prefix) {
  TRY(const auto output, CallCluster(cluster_, cluster_.look, {}, "", deadline_));
  if (output.exit_code != 0) return Silence(cluster_.look, output);
  Result<std::vector<JobStatus>> jobs = ParseQueue(output.out, cluster_);
  if (!jobs) return jobs;
  for (const JobStatus& job : *jobs) {
    if (job.name.starts_with(name_prefix)) continue;
    // A job of ours without our name is one whose name was cut: another master would never find it.
    if (std::ranges::any_of(submitted_, [&](const std::string& id) { return IsOf(id, job.id); }))
      return Error{ErrorKind::kIo, ProgramOf(cluster_.look) + " gives job " + job.id + " the name '" +
                                       job.name + "', not " + name_prefix +
                                       "...: `look` has to print whole names"};
  }
  std::erase_if(*jobs, [&](const JobStatus& job) { return !job.name.starts_with(name_prefix); });
  return jobs;
}

Status CommandLineSlurm::Cancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return Ok{};
  TRY(const auto output, CallCluster(cluster_, cluster_.cancel, jobs, "", deadline_));
  if (output.exit_code != 0) return Silence(cluster_.cancel, output);
  return Ok{};
}

}  // namespace gauntlet::slurm
