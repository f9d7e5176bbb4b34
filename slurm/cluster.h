// A cluster as Gauntlet speaks to it: what a cluster file says (slurm/clusters/, docs/clusters.md).
#pragma once

#include <array>
#include <map>
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

struct ClusterHost {
  std::string name;  // as ssh takes it
  int slots = 1;     // workers there at the same time
};

// Commands are lines of bash, in which "$@" are the arguments.
struct Cluster {
  std::string name;     // of the scheduler, for sentences
  std::string submit;   // job script on stdin; arguments: further options
  std::string test;     // likewise, and submits nothing: exit code 0 when the job could start; "" = none
  std::string look;     // prints kLookForm of each of this user's jobs, of arrays each task
  std::string cancel;   // arguments: ids as `look` prints them
  std::string job_id;   // regular expression; its first group in submit's answer is the job's id
  std::string task_id;  // id of an array's task, made of @JOB@ and @TASK@; "" = there are no arrays
  std::string exclude;  // options that keep a job off @NODES@, apart by blanks; "" = there are none
  std::string node_separator;             // between them
  std::string script;                     // of a job, as job_script.h fills it in, or kSlurmScripts
  std::string connect;                    // of hosts: reaches one; arguments: its name and a command
  std::vector<ClusterHost> hosts;         // instead of a scheduler
  std::vector<std::string> never_starts;  // states and reasons with which a waiting job stays for ever
  std::map<std::string, std::string> directives;  // the script's line with @VALUE@, by what is asked for
  std::map<std::string, JobPhase> states;
  std::map<std::string, std::string> advice;  // what a person can do about words of the scheduler
  // Failed starts in a row without a word from any worker ever, after which the master ends; 0 = never.
  int give_up_after = 20;
};

// A script that stands for Slurm's two, slurm/worker.sbatch and slurm/master.sbatch.
inline constexpr std::string_view kSlurmScripts = "sbatch";

// The files slurm/clusters/*.toml.
struct ShippedCluster {
  std::string_view name;
  std::string_view text;
};
extern const std::array<ShippedCluster, 4> kShippedClusters;

// The form of the lines that `look` prints.
inline constexpr std::string_view kLookForm = "id|state|node|reason|name";

// Slurm's own, which is meant where no other cluster is named.
const Cluster& SlurmCluster();

// The cluster that `text` describes, on top of the shipped one that its `like` names. Errors: malformed TOML,
// an unknown key or phase, what is missing, and a template without a placeholder that it needs.
Result<Cluster> ReadCluster(std::string_view text, const std::string& file_name);

// "slurm", "sge", "pbs", or the path of a cluster file. Errors: those of ReadCluster, an unknown name.
Result<Cluster> FindCluster(const std::string& name);

// Whether `name` is meant as the path of a file.
bool IsClusterFile(std::string_view name);

}  // namespace gauntlet::slurm
