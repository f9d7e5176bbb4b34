// The batch scripts that are handed to sbatch and its like.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "slurm/cluster.h"

namespace gauntlet::slurm {

// What a site or a user wants of their jobs; empty = the cluster's default.
struct JobRequest {
  std::string partition;
  std::string account;
  std::string qos;
  std::string constraint;
  std::string memory;                   // per job, "2G"
  std::string time_limit = "01:00:00";  // of one allocation
  std::vector<std::string> extra;       // further options of submit, "--exclusive"
  std::string setup;                    // shell lines before the program, "module load zeromq"
};

struct WorkerJob {
  std::string name;           // of the job
  std::string worker;         // command line of gauntlet-worker, already quoted where it needs to be
  std::string access_file;    // absolute
  std::string log_directory;  // absolute
  int slots = 1;
  int array = 1;  // equal allocations, as the tasks of one array job when more than one
};

struct MasterJob {
  std::string name;
  std::vector<std::string> command;  // arguments
  std::string log_directory;         // absolute
};

// `text` with `value` for the first `name` in it, "@NODES@".
std::string Replaced(std::string text, std::string_view name, std::string_view value);

// The shipped templates slurm/worker.sbatch and slurm/master.sbatch.
extern const std::string_view kWorkerTemplate;
extern const std::string_view kMasterTemplate;
// slurm/run_job.sh, for which @RUN@ stands in the template of another cluster; it names the log by itself.
extern const std::string_view kRunJob;

// Paths may hold whatever a name may hold except line breaks. The log's name has the job's id in it, unless a
// directory's name has a backslash: Slurm then fills nothing in, and all jobs append to one file.
// Errors: a value that cannot stand in a directive (a line break), a setting for which the cluster has no
// directive, a template without a name that is needed or with one that is not known.
Result<std::string> WorkerScript(std::string_view job_template, const WorkerJob& job,
                                 const JobRequest& request, const Cluster& cluster = SlurmCluster());
Result<std::string> MasterScript(std::string_view job_template, const MasterJob& job,
                                 const JobRequest& request, const Cluster& cluster = SlurmCluster());

}  // namespace gauntlet::slurm
