// What a scheduler says of a job.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "slurm/cluster.h"

namespace gauntlet::slurm {

struct JobStatus {
  std::string id;     // "123", or the cluster's task_id for a task of an array
  std::string name;   // the whole of it
  std::string state;  // the scheduler's word, "PENDING"
  JobPhase phase = JobPhase::kUnknown;
  std::string reason;  // why it waits or ended, "Resources"; "" when it says "None"
  std::string nodes;   // "node3"; "" while it waits
};

// The word's row in the cluster's table of states.
JobPhase PhaseOf(std::string_view state, const Cluster& cluster = SlurmCluster());

// Does a waiting job with this reason, or in this state, never start by itself?
bool NeverStarts(std::string_view word, const Cluster& cluster = SlurmCluster());

// What `look` printed. Error: a line that is not of the form kLookForm, quoted.
Result<std::vector<JobStatus>> ParseQueue(std::string_view text, const Cluster& cluster = SlurmCluster());

// The job's id in what `submit` answered. Error: quotes what has none.
Result<std::string> ParseJobId(std::string_view text, const Cluster& cluster = SlurmCluster());

// "squeue": the first word of a command, for messages; on hosts of what reaches them.
std::string ProgramOf(const std::string& command, const Cluster& cluster);

// "02:00:00", "1-00:00:00", "30" (minutes), "10:30" (minutes and seconds): a time limit as sbatch(1) takes
// it, in seconds. Error: quotes it and says what would be right.
Result<long> ParseTimeLimit(std::string_view text);

}  // namespace gauntlet::slurm
