#include "slurm/ssh_hosts.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <utility>

namespace gauntlet::slurm {
namespace {

constexpr std::chrono::seconds kDeadline{60};

}  // namespace

SshHosts::SshHosts(const Cluster& cluster, int slots_per_job) {
  for (const ClusterHost& host : cluster.hosts) {
    Cluster alone = cluster;
    alone.hosts = {host};
    hosts_.push_back({.name = host.name,
                      .most_jobs = std::max(1, host.slots / std::max(1, slots_per_job)),
                      .client = CommandLineSlurm(alone, kDeadline)});
  }
}

int SshHosts::room() const {
  int jobs = 0;
  for (const Host& host : hosts_) jobs += host.most_jobs;
  return jobs;
}

Status SshHosts::Ask(Host& host, const std::function<Status(CommandLineSlurm&)>& question) {
  if (host.out) return InvalidInput(host.silence);
  Status answer = question(host.client);
  // The host that refuses a job has answered.
  const bool answered = answer || answer.error().kind == ErrorKind::kInvalidInput;
  host.silence = answered ? "" : answer.error().message;
  host.out = !answer && answer.error().kind == ErrorKind::kNotFound;
  return answer;
}

// Says too what is wrong with which hosts; where all have refused, that none can be used (kNotFound).
Error SshHosts::Nobody(ErrorKind kind, std::string words) const {
  if (std::ranges::all_of(hosts_, &Host::out)) {
    kind = ErrorKind::kNotFound;
    words = "no host can be used";
  }
  for (const Host& host : hosts_) {
    if (host.silence.empty()) continue;
    words += fmt::format("; {} {}: {}", host.name,
                         host.out ? "is out until `gauntlet resume`" : "does not answer", host.silence);
  }
  return {kind, words};
}

Result<std::string> SshHosts::Submit(const std::string& script, const std::vector<std::string>& options) {
  if (!looked_) (void)Queue("").ok();
  const auto room = [](const Host* host) { return host->most_jobs - static_cast<int>(host->jobs.size()); };
  std::vector<Host*> candidates;
  for (Host& host : hosts_) {
    if (host.silence.empty() && room(&host) > 0) candidates.push_back(&host);
  }
  std::ranges::stable_sort(candidates, std::greater<>(), room);
  for (Host* host : candidates) {
    JobStatus job = {"", "", "RUNNING", JobPhase::kRunning, "", host->name};
    const Status started = Ask(*host, [&](CommandLineSlurm& client) -> Status {
      TRY(job.id, client.Submit(script, options));
      return Ok{};
    });
    if (!started && host->silence.empty()) return started.error();
    if (!started) continue;
    host->jobs.push_back(job);
    return job.id;
  }
  return Nobody(ErrorKind::kInUse, "no host has room for another job");
}

Result<std::vector<JobStatus>> SshHosts::Queue(const std::string& name_prefix) {
  looked_ = true;
  std::vector<std::future<Status>> looks;
  for (Host& host : hosts_) {
    looks.push_back(std::async(std::launch::async, [this, &host] {
      return Ask(host, [&](CommandLineSlurm& client) -> Status {
        TRY(host.jobs, client.Queue(""));
        return Ok{};
      });
    }));
  }
  for (std::future<Status>& look : looks) look.wait();
  std::vector<JobStatus> jobs;
  for (const Host& host : hosts_) {
    for (const JobStatus& job : host.jobs) {
      // What was started since the host's last answer has no name yet, and is ours.
      if (!job.name.empty() && !job.name.starts_with(name_prefix)) continue;
      jobs.push_back(job);
      if (!host.silence.empty()) jobs.back().reason = "its host does not answer";
    }
  }
  const bool some = std::ranges::any_of(hosts_, [](const Host& host) { return host.silence.empty(); });
  if (some || !jobs.empty()) return jobs;
  return Nobody(ErrorKind::kIo, "no host answers");
}

Status SshHosts::Cancel(const std::vector<std::string>& jobs) {
  std::vector<std::future<Status>> answers;
  for (Host& host : hosts_) {
    std::vector<std::string> there;
    for (const std::string& job : jobs) {
      if (job.substr(job.find('@') + 1) == host.name) there.push_back(job);
    }
    if (there.empty()) continue;
    answers.push_back(std::async(std::launch::async, [this, &host, there] {
      return Ask(host, [&](CommandLineSlurm& client) { return client.Cancel(there); });
    }));
  }
  Status done = Ok{};
  for (std::future<Status>& answer : answers) {
    if (Status one = answer.get(); !one) done = std::move(one);
  }
  return done;
}

}  // namespace gauntlet::slurm
