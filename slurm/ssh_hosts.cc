#include "slurm/ssh_hosts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <regex>
#include <sstream>
#include <utility>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "base/split.h"

namespace gauntlet::slurm {
namespace {

constexpr std::chrono::seconds kDeadline{60};

// Before each line that is meant for us: shells greet their users in many ways.
constexpr std::string_view kMark = "gauntlet:";

// Programs for bash on the host, which has the variables that Ask sets (proc(5): of /proc/PID/stat behind the
// name, the session is the 4th field and the time of the start the 20th).
constexpr std::string_view kFunctions = R"sh(
start_of() {
  local stat
  { read -r stat <"/proc/$1/stat"; } 2>/dev/null || return
  set -- ${stat##*) }
  session=$4 start=${20}
  [ "$1" != Z ]
}
)sh";
constexpr std::string_view kStart = R"sh(
unset GAUNTLET_BATCH_JOB
setsid /bin/bash -c "$script" </dev/null >/dev/null 2>&1 &
start_of $! && echo "gauntlet:$!.$start@$GAUNTLET_HOST"
)sh";
constexpr std::string_view kLook = R"sh(
for file in $(grep -lszxF "GAUNTLET_HOST=$GAUNTLET_HOST" /proc/[0-9]*/environ); do
  pid=${file#/proc/} pid=${pid%/environ} job= name=
  while IFS= read -r -d '' entry; do
    case $entry in
      GAUNTLET_BATCH_JOB=*) job=${entry#*=} ;;
      GAUNTLET_JOB=*) name=${entry#*=} ;;
    esac
  done <"$file"
  [ -z "$job" ] && start_of "$pid" && [ "$session" = "$pid" ] && job=$pid.$start@$GAUNTLET_HOST
  [ -n "$job" ] && echo "gauntlet:$job|RUNNING|$GAUNTLET_HOST||$name"
done 2>/dev/null | sort -u
echo gauntlet:end
)sh";
constexpr std::string_view kCancel = R"sh(
leader_of() { start_of "${1%%.*}" && [ "$start" = "${1#*.}" ] && echo "${1%%.*}"; }
all_of() {
  leader_of "$1"
  for file in $(grep -lszxF "GAUNTLET_BATCH_JOB=$1@$GAUNTLET_HOST" /proc/[0-9]*/environ); do
    pid=${file#/proc/}
    echo "${pid%/environ}"
  done
}
for job in $jobs; do kill -TERM $(leader_of "$job" || all_of "$job"); done 2>/dev/null
(sleep 30; for job in $jobs; do kill -KILL $(all_of "$job"); done) </dev/null >/dev/null 2>&1 &
echo gauntlet:end
)sh";

// The line in which OpenSSH says that it is of no use to try again; "" when none does.
std::string Refusal(const std::string& text) {
  constexpr std::array<std::string_view, 5> kRefusals = {
      "Permission denied", "Host key verification failed", "Too many authentication failures",
      "No supported authentication methods", "Name or service not known"};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (const std::string_view refusal : kRefusals) {
      if (line.find(refusal) != std::string::npos) return std::string(Trimmed(line));
    }
  }
  return "";
}

std::string LastLine(std::string_view text) {
  text = Trimmed(text);
  return std::string(Trimmed(text.substr(text.rfind('\n') + 1)));
}

std::pair<std::string, std::string> ProcessAndHost(const std::string& job) {
  const std::size_t at = std::min(job.find('@'), job.size());
  return {job.substr(0, at), job.substr(std::min(at + 1, job.size()))};
}

}  // namespace

SshHosts::SshHosts(Cluster cluster, int slots_per_job) : cluster_(std::move(cluster)) {
  for (const ClusterHost& host : cluster_.hosts)
    hosts_.push_back({.name = host.name, .most_jobs = std::max(1, host.slots / std::max(1, slots_per_job))});
}

int SshHosts::room() const {
  int jobs = 0;
  for (const Host& host : hosts_) jobs += host.most_jobs;
  return jobs;
}

// The lines of the answer that are meant for us.
Result<std::vector<std::string>> SshHosts::Ask(Host& host, const Variables& variables,
                                               std::string_view program) {
  if (!host.refusal.empty()) return InvalidInput(host.refusal);
  std::string text = fmt::format("export GAUNTLET_HOST={}\n", host.name);
  for (const auto& [name, value] : variables) text += fmt::format("{}={}\n", name, ShellQuoted(value));
  text.append(kFunctions).append(program);
  const Result<CallOutput> output =
      CallCluster(cluster_, cluster_.connect, {host.name, "exec /bin/bash -s"}, text, kDeadline);
  std::vector<std::string> lines;
  std::istringstream answer(output ? output->out : "");
  for (std::string line; std::getline(answer, line);) {
    if (line.starts_with(kMark)) lines.push_back(line.substr(kMark.size()));
  }
  host.silence = output ? "" : output.error().message;
  if (output && (output->exit_code != 0 || lines.empty())) {
    host.refusal = Refusal(output->err);
    host.silence = LastLine(output->err.empty() ? output->out : output->err);
    if (host.silence.empty()) host.silence = fmt::format("no answer, exit code {}", output->exit_code);
  }
  if (!output && output.error().kind == ErrorKind::kNotFound) host.refusal = host.silence;
  if (host.silence.empty()) return lines;
  return Error{ErrorKind::kIo, host.silence};
}

void SshHosts::Look(Host& host) {
  const Result<std::vector<std::string>> lines = Ask(host, {}, kLook);
  if (!lines || lines->back() != "end") return;
  host.looked = true;
  host.jobs.clear();
  for (const std::string& line : *lines) {
    if (const Result<std::vector<JobStatus>> job = ParseQueue(line, cluster_); job && line != "end")
      host.jobs.insert(host.jobs.end(), job->begin(), job->end());
  }
}

Status SshHosts::SomeMayBeAsked() const {
  if (std::ranges::any_of(hosts_, [](const Host& host) { return host.refusal.empty(); })) return Ok{};
  return Error{ErrorKind::kNotFound, "no host can be used" + Troubles()};
}

// What is wrong with which hosts.
std::string SshHosts::Troubles() const {
  std::string troubles;
  for (const Host& host : hosts_) {
    if (host.silence.empty() && host.refusal.empty()) continue;
    troubles += fmt::format("; {} {}: {}", host.name,
                            host.refusal.empty() ? "does not answer" : "is out until `gauntlet resume`",
                            host.refusal.empty() ? host.silence : host.refusal);
  }
  return troubles;
}

Result<std::string> SshHosts::Submit(const std::string& script, const std::vector<std::string>& /*options*/) {
  static const std::regex kName("\n# (gauntlet-[A-Za-z0-9._-]+)");
  std::smatch name;
  if (!std::regex_search(script, name, kName))
    return InvalidInput("the script of a job on a host begins with a line `# @JOB_NAME@`");
  if (std::ranges::none_of(hosts_, &Host::looked)) (void)Queue("").ok();
  const auto room = [](const Host* host) { return host->most_jobs - static_cast<int>(host->jobs.size()); };
  std::vector<Host*> candidates;
  for (Host& host : hosts_) {
    if (host.silence.empty() && host.refusal.empty() && room(&host) > 0) candidates.push_back(&host);
  }
  std::ranges::stable_sort(candidates, std::greater<>(), room);
  for (Host* host : candidates) {
    const Result<std::vector<std::string>> job =
        Ask(*host, {{"export GAUNTLET_JOB", name.str(1)}, {"script", script}}, kStart);
    if (!job) continue;
    host->jobs.push_back({job->front(), name.str(1), "RUNNING", JobPhase::kRunning, "", host->name});
    return job->front();
  }
  TRY(SomeMayBeAsked());
  return Error{ErrorKind::kInUse, "no host has room for another job" + Troubles()};
}

Result<std::vector<JobStatus>> SshHosts::Queue(const std::string& name_prefix) {
  std::vector<std::future<void>> looks;
  for (Host& host : hosts_) looks.push_back(std::async(std::launch::async, [this, &host] { Look(host); }));
  for (std::future<void>& look : looks) look.wait();
  std::vector<JobStatus> jobs;
  for (const Host& host : hosts_) {
    for (const JobStatus& job : host.jobs) {
      if (!job.name.starts_with(name_prefix)) continue;
      jobs.push_back(job);
      if (!host.silence.empty()) jobs.back().reason = "its host does not answer";
    }
  }
  const bool some = std::ranges::any_of(hosts_, [](const Host& host) { return host.silence.empty(); });
  if (some || !jobs.empty()) return jobs;
  TRY(SomeMayBeAsked());
  return Error{ErrorKind::kIo, "no host answers" + Troubles()};
}

Status SshHosts::Cancel(const std::vector<std::string>& jobs) {
  std::vector<std::future<Result<std::vector<std::string>>>> answers;
  for (Host& host : hosts_) {
    std::string processes;
    for (const std::string& job : jobs) {
      const auto [process, name] = ProcessAndHost(job);
      if (name == host.name) processes += " " + process;
    }
    if (processes.empty()) continue;
    answers.push_back(std::async(std::launch::async, [this, &host, processes] {
      return Ask(host, {{"jobs", processes}}, kCancel);
    }));
  }
  Status done = Ok{};
  for (auto& answer : answers) {
    if (const auto lines = answer.get(); !lines) done = lines.error();
  }
  return done;
}

}  // namespace gauntlet::slurm
