// A campaign directory as a cluster's jobs see it: their names, their scripts, and which of a user's jobs
// belong to the campaign.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/dispatch/pool/worker_pool.h"
#include "slurm/slurm_client.h"
#include "slurm/slurm_settings.h"

namespace gauntlet::slurm {

class SlurmCampaign {
 public:
  // `directory` need not exist yet. Error: the cluster is unknown, a template of the site cannot be read, or
  // does not give a script.
  static Result<SlurmCampaign> Make(const SlurmSettings& settings, const std::string& directory);
  // The campaign in `directory` as it was submitted, from its slurm.toml, which says what jobs execute;
  // nothing when it was not. Error: also when somebody else could have written that file.
  static Result<std::optional<SlurmCampaign>> Find(const std::string& directory);

  const SlurmSettings& settings() const { return settings_; }
  const Cluster& cluster() const { return cluster_; }
  // As the settings say, but no more than the cluster's hosts have room for.
  PoolLimits limits() const;
  // What speaks to the cluster.
  std::unique_ptr<SlurmClient> MakeClient() const;
  // All jobs of the campaign have names that begin so. Made of the settings' tag and the directory's absolute
  // path: a copy of the directory has other jobs than its original.
  const std::string& job_prefix() const { return job_prefix_; }
  std::string master_job_name() const { return job_prefix_ + "master"; }

  const std::string& worker_script() const { return worker_script_; }
  const std::string& master_script() const { return master_script_; }

  // This user's jobs of the campaign that have not ended yet.
  Result<std::vector<JobStatus>> LivingJobs(SlurmClient& client) const;
  // Cancels what the cluster still has of the campaign; the answer is the ids of what was cancelled.
  Result<std::vector<std::string>> CancelJobs(SlurmClient& client) const;
  // The pool of the campaign's workers.
  std::unique_ptr<WorkerPool> MakePool(std::unique_ptr<SlurmClient> client) const;

 private:
  SlurmCampaign(SlurmSettings settings, std::string directory);
  Status MakeScripts();
  WorkerJob WorkersJob() const;

  SlurmSettings settings_;
  Cluster cluster_;
  std::string directory_;  // absolute
  std::string job_prefix_;
  std::string worker_template_;
  std::string worker_script_;
  std::string master_script_;
};

// "flocking-1a2b3c4d": the name, as far as it can stand in a job's, and random digits.
std::string DrawTag(const std::string& experiment_name);

}  // namespace gauntlet::slurm
