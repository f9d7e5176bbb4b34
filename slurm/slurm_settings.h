// How a campaign uses a cluster: the [slurm] table of an experiment, the user's own file and --slurm, one
// schema.
#pragma once

#include <string>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "slurm/job_script.h"
#include "slurm/pool_policy.h"

namespace gauntlet::slurm {

// Where the campaign's master runs.
enum class MasterPlace { kJob, kHere };

struct SlurmSettings {
  std::string cluster = "slurm";  // as FindCluster takes it
  JobRequest worker_job;
  PoolLimits pool;
  std::string worker_command;   // as the shell is to read it; "" = gauntlet-worker beside this program
  std::string worker_template;  // path of an edited slurm/worker.sbatch; "" = the cluster's
  std::string master_template;
  std::string master_time_limit = "7-00:00:00";
  std::string master_partition;  // "" = that of the workers
  MasterPlace master = MasterPlace::kJob;
  std::string bind = "tcp://0.0.0.0:*";  // where the master listens to workers
  std::string tag;                       // part of the jobs' names, drawn when the campaign is submitted
};

// Texts to read, the later ones win: files as (content, name for messages) and "key=value" of --slurm. Of an
// experiment file only the [slurm] table counts (`whole_file` false); in the user's own file and a campaign's
// slurm.toml the keys stand at the top. Errors name the place, the key, what is allowed, and the nearest
// known key.
struct SlurmSource {
  std::string text;
  std::string name;
  bool whole_file = false;
};
Result<SlurmSettings> ReadSlurmSettings(const std::vector<SlurmSource>& files,
                                        const std::vector<std::string>& sets);

// All keys written out, for the campaign's slurm.toml; ReadSlurmSettings gives back an equal one.
std::string WriteSlurmSettings(const SlurmSettings& settings);

// $XDG_CONFIG_HOME/gauntlet/slurm.toml or ~/.config/gauntlet/slurm.toml.
std::string UserSlurmFile();

using SlurmKey = SettingsKey<SlurmSettings>;
// All that can be set, with its default.
const std::vector<SlurmKey>& SlurmKeys();

}  // namespace gauntlet::slurm
