#include "slurm/slurm_client.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

#include "base/shell_quoted.h"
#include "base/split.h"
#include "slurm/job_script.h"

namespace gauntlet::slurm {
namespace {

// "sbatch: error: Batch job submission failed: Invalid account" without the lines' prefixes, in one line.
std::string OneLineOf(const std::string& program, const std::string& text) {
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

// Whether the id that the queue shows is this job, or a task of it.
bool IsOf(const std::string& job, const std::string& id) {
  return id.starts_with(job) &&
         (id.size() == job.size() || std::isdigit(static_cast<unsigned char>(id[job.size()])) == 0);
}

// Around an answer: shells greet their users in many ways.
constexpr std::string_view kBegin = "gauntlet:begin\n";
constexpr std::string_view kEnd = "gauntlet:end\n";
constexpr int kSshFailed = 255;  // ssh(1), exit status

std::string OnHost(const std::string& host, const std::string& command,
                   const std::vector<std::string>& arguments, std::string_view input) {
  std::string run = "run";
  for (const std::string& argument : arguments) run += " " + ShellQuoted(argument);
  return fmt::format("export GAUNTLET_HOST={}\nrun() {{ :\n{}\n}}\necho {}{} <<<{} && echo {}", host, command,
                     kBegin, run, ShellQuoted(input), kEnd);
}

// What stands between the marks. Error, where the command has begun: its last words, of kind `failure`; else
// the line of OpenSSH that says that it is of no use to try again (kNotFound), or the last line.
Result<CallOutput> AnswerOfHost(const CallOutput& output, ErrorKind failure) {
  constexpr std::array<std::string_view, 5> kRefusals = {
      "Permission denied (", "Host key verification failed", "Too many authentication failures",
      "No supported authentication methods", "Name or service not known"};
  const std::size_t begin = output.out.rfind(kBegin);
  const bool begun = begin != std::string::npos;
  if (begun && output.exit_code == 0 && output.out.ends_with(kEnd)) {
    const std::size_t size = output.out.size() - kEnd.size() - begin - kBegin.size();
    return CallOutput{.out = output.out.substr(begin + kBegin.size(), size)};
  }
  std::string words = fmt::format("no answer, exit code {}", output.exit_code);
  std::istringstream lines(begun ? output.err : output.out + "\n" + output.err);
  for (std::string line; std::getline(lines, line);) {
    line = Trimmed(line);
    for (const std::string_view refusal : kRefusals) {
      if (output.exit_code == kSshFailed && line.find(refusal) != std::string::npos)
        return Error{ErrorKind::kNotFound, line};
    }
    if (!line.empty()) words = line;
  }
  return Error{begun && output.exit_code != kSshFailed ? failure : ErrorKind::kIo, words};
}

// A command of a cluster in bash, where it has hosts on the one host: fails as the first program of a pipe
// that does. Error: its words, of kind `failure`; kNotFound when there is no such program, or no use in
// asking the host again.
Result<CallOutput> CallCluster(const Cluster& cluster, const std::string& command,
                               std::vector<std::string> arguments, std::string_view input,
                               std::chrono::milliseconds deadline, ErrorKind failure = ErrorKind::kIo) {
  CallOptions options;
  options.deadline = deadline;
  options.inherits = Inherits;
  const std::string program = ProgramOf(command, cluster);
  std::string text(input);
  if (!cluster.hosts.empty()) {
    text = OnHost(cluster.hosts.front().name, command, arguments, text);
    arguments = {cluster.hosts.front().name, "exec /bin/bash -o pipefail -s"};
  }
  std::vector<std::string> line = {"/bin/bash", "--norc", "-o",
                                   "pipefail",  "-c",     cluster.hosts.empty() ? command : cluster.connect,
                                   program};
  line.insert(line.end(), arguments.begin(), arguments.end());
  const Result<CallOutput> call = CallProcess(line, text, options);
  if (!call) return Error{call.error().kind, Replaced(call.error().message, line.front(), program)};
  const CallOutput& output = *call;
  const auto says = [&](const char* what) { return output.err.find(program + what) != std::string::npos; };
  constexpr int kNoSuchProgram = 127;
  if (output.exit_code == kNoSuchProgram &&
      (says(": command not found") || says(": No such file or directory")))
    return Error{ErrorKind::kNotFound,
                 "there is no " + program + " in PATH: is " + cluster.name + " installed on this machine?"};
  if (!cluster.hosts.empty()) return AnswerOfHost(output, failure);
  if (output.exit_code == 0) return output;
  return Error{failure, fmt::format("{}{}: {}", program,
                                    failure == ErrorKind::kInvalidInput
                                        ? fmt::format(" refused (exit code {})", output.exit_code)
                                        : "",
                                    OneLineOf(program, output.err + output.out))};
}

// sbatch --test-only asks the controller twice: an absent one costs it 18 s (seen with 22.05).
constexpr int kTestOnlyCalls = 2;

}  // namespace

std::string NextStep(std::string_view message, const Cluster& cluster) {
  for (const auto& [words, step] : cluster.advice) {
    if (message.find(words) != std::string_view::npos) return "; " + step;
  }
  return "";
}

Result<std::string> CommandLineSlurm::Submit(const std::string& script,
                                             const std::vector<std::string>& options) {
  TRY(const auto output,
      CallCluster(cluster_, cluster_.submit, options, script, deadline_, ErrorKind::kInvalidInput));
  Result<std::string> job = ParseJobId(output.out, cluster_);
  if (job) submitted_.push_back(*job);
  return job;
}

Result<std::string> CommandLineSlurm::TestOnly(const std::string& script,
                                               const std::vector<std::string>& options) {
  if (cluster_.test.empty()) return std::string();
  TRY(const auto output, CallCluster(cluster_, cluster_.test, options, script, kTestOnlyCalls * deadline_,
                                     ErrorKind::kInvalidInput));
  return OneLineOf(ProgramOf(cluster_.test, cluster_), output.err + output.out);
}

Result<std::vector<JobStatus>> CommandLineSlurm::Queue(const std::string& name_prefix) {
  TRY(const auto output, CallCluster(cluster_, cluster_.look, {}, "", deadline_));
  TRY(std::vector<JobStatus> jobs, ParseQueue(output.out, cluster_));
  for (const JobStatus& job : jobs) {
    if (job.name.starts_with(name_prefix)) continue;
    // A job of ours without our name is one whose name was cut: another master would never find it.
    if (std::ranges::any_of(submitted_, [&](const std::string& id) { return IsOf(id, job.id); }))
      return Error{ErrorKind::kIo, ProgramOf(cluster_.look, cluster_) + " gives job " + job.id +
                                       " the name '" + job.name + "', not " + name_prefix +
                                       "...: `look` has to print whole names"};
  }
  std::erase_if(jobs, [&](const JobStatus& job) { return !job.name.starts_with(name_prefix); });
  return jobs;
}

Status CommandLineSlurm::Cancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return Ok{};
  TRY(CallCluster(cluster_, cluster_.cancel, jobs, "", deadline_));
  return Ok{};
}

}  // namespace gauntlet::slurm
