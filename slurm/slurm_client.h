// The few things Gauntlet asks of Slurm, and the commands that do them.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "slurm/job_status.h"

namespace gauntlet::slurm {

// Errors carry Slurm's own words. Calls block; each is bounded in time.
class SlurmClient {
 public:
  virtual ~SlurmClient() = default;
  // `script` goes to sbatch with `options` before it; the answer is the job's id (of an array, the array's).
  virtual Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) = 0;
  // What sbatch --test-only says: when and where the job could start. Error: why it never could.
  virtual Result<std::string> TestOnly(const std::string& script,
                                       const std::vector<std::string>& options) = 0;
  // This user's jobs whose name begins with `name_prefix`.
  virtual Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) = 0;
  // Jobs that are gone already are no error. An empty list does nothing.
  virtual Status Cancel(const std::vector<std::string>& jobs) = 0;
};

// What a person can do about Slurm's words, as "; do this"; "" when nothing is known.
std::string NextStep(std::string_view words);

class CommandLineSlurm final : public SlurmClient {
 public:
  // An absent controller costs a Slurm command about 9 s before it says so.
  explicit CommandLineSlurm(std::chrono::milliseconds deadline = std::chrono::seconds(15))
      : deadline_(deadline) {}

  Result<std::string> Submit(const std::string& script, const std::vector<std::string>& options) override;
  Result<std::string> TestOnly(const std::string& script, const std::vector<std::string>& options) override;
  Result<std::vector<JobStatus>> Queue(const std::string& name_prefix) override;
  Status Cancel(const std::vector<std::string>& jobs) override;

 private:
  std::chrono::milliseconds deadline_;
};

}  // namespace gauntlet::slurm
