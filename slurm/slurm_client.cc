#include "slurm/slurm_client.h"

#include <array>
#include <sstream>

#include "base/system/process_call.h"

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

Result<CallOutput> CallSlurm(const std::vector<std::string>& arguments, std::string_view input,
                             std::chrono::milliseconds deadline) {
  CallOptions options;
  options.deadline = deadline;
  options.inherits = Inherits;
  Result<CallOutput> output = CallProcess(arguments, input, options);
  if (output || output.error().kind != ErrorKind::kNotFound) return output;
  return Error{ErrorKind::kNotFound,
               output.error().message + " in PATH: is Slurm installed on this machine?"};
}

Error Refusal(const std::string& program, const CallOutput& output) {
  return {ErrorKind::kInvalidInput, program + " refused (exit code " + std::to_string(output.exit_code) +
                                        "): " + WordsOf(program, output.err + output.out)};
}

std::vector<std::string> Sbatch(const std::vector<std::string>& own,
                                const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"sbatch"};
  arguments.insert(arguments.end(), own.begin(), own.end());
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

// sbatch --test-only asks the controller twice: an absent one costs it 18 s (seen with 22.05).
constexpr int kTestOnlyCalls = 2;

struct Advice {
  std::string_view words;
  std::string_view step;
};
// Words of Slurm 22.05 to 23.11 (slurm_errno.c, squeue(1) "JOB REASON CODES").
constexpr std::array kAdvice = {
    Advice{"no sbatch", "run this on a login node of the cluster, or put Slurm's commands into PATH"},
    Advice{"nvalid account",
           "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)"},
    Advice{"InvalidAccount",
           "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)"},
    Advice{"nvalid partition", "choose another: --slurm partition=NAME (`sinfo -s` lists them)"},
    Advice{"nvalid qos", "choose another: --slurm qos=NAME (`sacctmgr show qos` lists them)"},
    Advice{"time limit is invalid",
           "ask for less: --slurm time_limit=HH:MM:SS (`sinfo -o '%P %l'` shows the limits)"},
    Advice{"PartitionTimeLimit",
           "ask for less: --slurm time_limit=HH:MM:SS (`sinfo -o '%P %l'` shows the limits)"},
    Advice{"nvalid feature", "correct --slurm constraint=FEATURES (`sinfo -o '%N %f'` lists them)"},
    Advice{"node configuration is not available",
           "no node has what is asked for: lower memory, workers_per_allocation or constraint (`sinfo -o '%P "
           "%c %m %f'`)"},
    Advice{"PartitionNodeLimit", "no node of the partition has what is asked for (`sinfo -o '%P %c %m %f'`)"},
    Advice{"PartitionConfig", "no node of the partition has what is asked for (`sinfo -o '%P %c %m %f'`)"},
    Advice{"BadConstraints", "no node has what is asked for: correct --slurm constraint=FEATURES"},
    Advice{"accounting/QOS policy",
           "a limit of the site: lower --slurm max_allocations and max_queued, or wait"},
    Advice{"SubmitJob", "a limit of the site: lower --slurm max_allocations and max_queued, or wait"},
    Advice{"temporarily unable to accept job",
           "the cluster's queue is full: wait, or lower --slurm max_queued"},
    Advice{"Resource temporarily unavailable", "the cluster's queue is full: try again later"},
    Advice{"contact slurm controller", "what runs goes on; `scontrol ping` says when it is back"},
};

}  // namespace

std::string NextStep(std::string_view words) {
  for (const Advice& advice : kAdvice) {
    if (words.find(advice.words) != std::string_view::npos) return "; " + std::string(advice.step);
  }
  return "";
}

Result<std::string> CommandLineSlurm::Submit(const std::string& script,
                                             const std::vector<std::string>& options) {
  TRY(const auto output, CallSlurm(Sbatch({"--parsable"}, options), script, deadline_));
  if (output.exit_code != 0) return Refusal("sbatch", output);
  return ParseJobId(output.out);
}

Result<std::string> CommandLineSlurm::TestOnly(const std::string& script,
                                               const std::vector<std::string>& options) {
  TRY(const auto output, CallSlurm(Sbatch({"--test-only"}, options), script, kTestOnlyCalls * deadline_));
  if (output.exit_code != 0) return Refusal("sbatch", output);
  return WordsOf("sbatch", output.err + output.out);
}

Result<std::vector<JobStatus>> CommandLineSlurm::Queue(const std::string& name_prefix) {
  TRY(const auto output, CallSlurm({"squeue", "--me", "--noheader", "--array", "--states=all",
                                    "--format=" + std::string(kQueueFormat)},
                                   "", deadline_));
  if (output.exit_code != 0)
    return Error{ErrorKind::kIo, "squeue: " + WordsOf("squeue", output.err + output.out)};
  Result<std::vector<JobStatus>> jobs = ParseQueue(output.out);
  if (jobs) std::erase_if(*jobs, [&](const JobStatus& job) { return !job.name.starts_with(name_prefix); });
  return jobs;
}

Status CommandLineSlurm::Cancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return Ok{};
  std::vector<std::string> arguments = {"scancel"};
  arguments.insert(arguments.end(), jobs.begin(), jobs.end());
  TRY(const auto output, CallSlurm(arguments, "", deadline_));
  if (output.exit_code != 0)
    return Error{ErrorKind::kIo, "scancel: " + WordsOf("scancel", output.err + output.out)};
  return Ok{};
}

}  // namespace gauntlet::slurm
