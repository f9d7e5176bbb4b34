// What Slurm says of a job.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet::slurm {

enum class JobPhase {
  kQueued,   // waits for resources, a dependency, a requeue delay or a person
  kRunning,  // has its nodes (also while they are prepared or suspended)
  kEnding,   // has ended, its nodes are not yet free
  kEnded,
  kUnknown,  // a word this program does not know: believed to live
};

struct JobStatus {
  std::string id;     // "123", or "123_4" for a task of an array
  std::string name;   // --job-name
  std::string state;  // Slurm's word, "PENDING"
  JobPhase phase = JobPhase::kUnknown;
  std::string reason;  // why it waits or ended, "Resources"; "" when Slurm says "None"
  std::string nodes;   // "node3"; "" while it waits
};

// Of a job state in its long form (squeue's %T, squeue(1) "JOB STATE CODES").
JobPhase PhaseOf(std::string_view state);

// Does a waiting job with this reason never start by itself? (squeue(1) "JOB REASON CODES": limits of the
// partition that the job exceeds, holds, dependencies that cannot be fulfilled.)
bool NeverStarts(std::string_view reason);

// The format that ParseQueue reads.
inline constexpr std::string_view kQueueFormat = "%i|%T|%N|%r|%j";

// The output of `squeue --noheader --array --format=kQueueFormat`. Error: a line with too few fields, quoted.
Result<std::vector<JobStatus>> ParseQueue(std::string_view text);

// The answer of `sbatch --parsable`: "123" or "123;cluster". Error: quotes what is no job id.
Result<std::string> ParseJobId(std::string_view text);

// "02:00:00", "1-00:00:00", "30" (minutes), "10:30" (minutes and seconds): a time limit as sbatch(1) takes
// it, in seconds. Error: quotes it and says what would be right.
Result<long> ParseTimeLimit(std::string_view text);

}  // namespace gauntlet::slurm
