// Hosts without a scheduler: jobs are started, found and ended over ssh.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slurm/slurm_client.h"

namespace gauntlet::slurm {

// A job's first process leads a session and has the job's name in its environment (GAUNTLET_JOB); the id is
// "PID.START@HOST": the process and the tick of the host's clock at which it started, so that a number that
// was given again is no job of ours. Whatever it starts has the id in its environment (slurm/run_job.sh), and
// the job lives as long as one of them. A host takes as many jobs of this user as
// its slots hold. One that refuses (a wrong key, an unknown host key) is asked no more by this object; one
// that does not answer is asked again, and until then has the jobs that it had. Thread-safety: one thread.
class SshHosts final : public SlurmClient {
 public:
  SshHosts(Cluster cluster, int slots_per_job);

  // Jobs that all hosts together take.
  int room() const;
  // On the host with the most room. Nothing can be tested before: a key is tried once.
  Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) override;
  // Asks all hosts at the same time. Error: none answers.
  Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) override;
  // SIGTERM, and half a minute later SIGKILL to what is left of the job.
  Status Cancel(const std::vector<std::string>& jobs) override;

 private:
  struct Host {
    std::string name;
    int most_jobs = 1;
    std::vector<JobStatus> jobs = {};  // of all campaigns, as it last said, and what was started since
    bool looked = false;
    std::string refusal = "";  // "" = it may be asked
    std::string silence = "";  // why its last answer failed
  };

  using Variables = std::vector<std::pair<std::string, std::string>>;
  Result<std::vector<std::string>> Ask(Host& host, const Variables& variables, std::string_view program);
  void Look(Host& host);
  Status SomeMayBeAsked() const;
  std::string Troubles() const;

  Cluster cluster_;
  std::vector<Host> hosts_;
};

}  // namespace gauntlet::slurm
