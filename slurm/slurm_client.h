// The few things Gauntlet asks of a scheduler, Slurm or another, and the commands that do them.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "base/system/process_call.h"
#include "slurm/job_status.h"

namespace gauntlet::slurm {

// Errors carry the scheduler's own words. Calls block; each is bounded in time.
class SlurmClient {
 public:
  virtual ~SlurmClient() = default;
  // `options` go to the command that gets the script; the answer is the job's id (of an array, the array's).
  // Errors: kInUse when there is no room just now, kNotFound when there never will be.
  virtual Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) = 0;
  // When and where the job could start, "" when that cannot be asked. Error: why it never could.
  virtual Result<std::string> TestOnly(const std::string& /*script*/,
                                       const std::vector<std::string>& /*options*/) {
    return std::string();
  }
  // This user's jobs whose name begins with `name_prefix`.
  virtual Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) = 0;
  // Jobs that are gone already are no error. An empty list does nothing.
  virtual Status Cancel(const std::vector<std::string>& jobs) = 0;
};

// What a person can do about a scheduler's words, as "; do this"; "" when nothing is known.
std::string NextStep(std::string_view message, const Cluster& cluster = SlurmCluster());

// By the commands of a cluster, of one with hosts on the first of them.
class CommandLineSlurm final : public SlurmClient {
 public:
  // An absent controller costs a Slurm command about 9 s before it says so.
  explicit CommandLineSlurm(Cluster cluster = SlurmCluster(),
                            std::chrono::milliseconds deadline = std::chrono::seconds(15))
      : cluster_(std::move(cluster)), deadline_(deadline) {}

  Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) override;
  Result<std::string> TestOnly(const std::string& script, const std::vector<std::string>& options) override;
  Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) override;
  Status Cancel(const std::vector<std::string>& jobs) override;

 private:
  Cluster cluster_;
  std::chrono::milliseconds deadline_;
  std::vector<std::string> submitted_;  // ids
};

}  // namespace gauntlet::slurm
