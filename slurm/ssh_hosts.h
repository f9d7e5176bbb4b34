// Hosts without a scheduler: the commands of the cluster start, find and end jobs on each of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slurm/slurm_client.h"

namespace gauntlet::slurm {

// A job's id ends in "@HOST" (slurm/clusters/ssh.toml). A host takes as many jobs of this user as its slots
// hold. One that refuses (a wrong key, an unknown host key) is asked no more by this object; one that does
// not answer is asked again, and until then has the jobs that it had. Thread-safety: one thread.
class SshHosts final : public SlurmClient {
 public:
  SshHosts(const Cluster& cluster, int slots_per_job);

  // Jobs that all hosts together take.
  int room() const;
  // On the host with the most room. Nothing can be tested before: a key is tried once.
  Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) override;
  // Asks all hosts at the same time. Error: none answers.
  Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) override;
  Status Cancel(const std::vector<std::string>& jobs) override;

 private:
  struct Host {
    std::string name;
    int most_jobs = 1;
    CommandLineSlurm client;
    std::vector<JobStatus> jobs = {};  // of all campaigns, as it last said, and what was started since
    std::string silence = "";          // why its last answer failed, "" = it did not
    bool out = false;                  // that was a refusal: it is asked no more
  };

  Status Ask(Host& host, const std::function<Status(CommandLineSlurm&)>& question);
  Error Nobody(ErrorKind kind, std::string words) const;

  std::vector<Host> hosts_;
  bool looked_ = false;
};

}  // namespace gauntlet::slurm
