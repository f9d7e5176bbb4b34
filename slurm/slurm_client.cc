#include "slurm/slurm_client.h"

#include <algorithm>

#include "slurm/process_call.h"

namespace gauntlet::slurm {
namespace {

// "sbatch: error: Batch job submission failed: Invalid account" without the lines' prefixes, in one line.
std::string WordsOf(const std::string& program, std::string text) {
  std::string words;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    for (const std::string& prefix : {program + ": ", std::string("error: ")}) {
      if (line.starts_with(prefix)) line.erase(0, prefix.size());
    }
    if (!line.empty()) words += (words.empty() ? "" : "; ") + line;
    begin = end + 1;
  }
  return words.empty() ? "it gave no reason" : words;
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

}  // namespace

Result<std::string> CommandLineSlurm::Submit(const std::string& script,
                                             const std::vector<std::string>& options) {
  const Result<CallOutput> output = CallProcess(Sbatch({"--parsable"}, options), script, deadline_);
  if (!output) return output.error();
  if (output->exit_code != 0) return Refusal("sbatch", *output);
  return ParseJobId(output->out);
}

Result<std::string> CommandLineSlurm::TestOnly(const std::string& script,
                                               const std::vector<std::string>& options) {
  const Result<CallOutput> output = CallProcess(Sbatch({"--test-only"}, options), script, deadline_);
  if (!output) return output.error();
  if (output->exit_code != 0) return Refusal("sbatch", *output);
  return WordsOf("sbatch", output->err + output->out);
}

Result<std::vector<JobStatus>> CommandLineSlurm::Queue(const std::string& name_prefix) {
  const Result<CallOutput> output = CallProcess(
      {"squeue", "--me", "--noheader", "--array", "--states=all", "--format=" + std::string(kQueueFormat)},
      "", deadline_);
  if (!output) return output.error();
  if (output->exit_code != 0)
    return Error{ErrorKind::kIo, "squeue: " + WordsOf("squeue", output->err + output->out)};
  Result<std::vector<JobStatus>> jobs = ParseQueue(output->out);
  if (jobs) std::erase_if(*jobs, [&](const JobStatus& job) { return !job.name.starts_with(name_prefix); });
  return jobs;
}

Status CommandLineSlurm::Cancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return Ok{};
  std::vector<std::string> arguments = {"scancel"};
  arguments.insert(arguments.end(), jobs.begin(), jobs.end());
  const Result<CallOutput> output = CallProcess(arguments, "", deadline_);
  if (!output) return output.error();
  if (output->exit_code != 0)
    return Error{ErrorKind::kIo, "scancel: " + WordsOf("scancel", output->err + output->out)};
  return Ok{};
}

}  // namespace gauntlet::slurm
