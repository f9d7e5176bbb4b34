// The commands of gauntlet: each takes its options as they were typed and answers with its exit code.
#pragma once

#include <string>
#include <vector>

#include "master/cli/command_context.h"
#include "master/cli/common_options.h"

namespace gauntlet::master {

// A search on a local pool of workers.
ExitCode RunEvolve(CommandContext& context, const CommonOptions& options);

struct RandomOptions {
  CommonOptions common;
  std::string cases;
};
// The baseline: random test cases.
ExitCode RunRandom(CommandContext& context, const RandomOptions& options);

struct EvaluateOptions {
  CommonOptions common;
  std::vector<std::string> files;
  std::string replicates;
};
// Simulates given test cases. kExitUsage when none of them gave a fitness.
ExitCode RunEvaluate(CommandContext& context, const EvaluateOptions& options);

// Of `options`, resume reads directory, workers, bind, insecure, as_job, json, quiet and no_progress; show
// reads directory and json.
ExitCode RunResume(CommandContext& context, const CommonOptions& options);
ExitCode RunShow(CommandContext& context, const CommonOptions& options);

struct MasterOptions {
  CommonOptions common;
  bool resume = false;  // go on with the campaign in the directory when there is one
};
// A master whose workers come from elsewhere.
ExitCode RunMaster(CommandContext& context, const MasterOptions& options);

struct SubmitOptions {
  CommonOptions common;
  std::string master;               // "job" or "here"; "" = as the settings say
  std::vector<std::string> slurm;   // "key=value"
  std::vector<std::string> sweeps;  // "key=a,b,c"
  std::string seeds;                // "1..20" or "1,5,9"
  bool dry_run = false;
};
// A search whose master and workers are jobs of a Slurm cluster.
ExitCode RunSubmit(CommandContext& context, const SubmitOptions& options);

struct StatusOptions {
  std::string directory;
  bool json = false;
};
ExitCode RunStatus(CommandContext& context, const StatusOptions& options);
// The status every second, until there is no master any more.
ExitCode RunWatch(CommandContext& context, const StatusOptions& options);
// Lets a campaign end what has begun and stop; returns when its master is gone.
ExitCode RunStop(CommandContext& context, const StatusOptions& options);

struct ReplayOptions {
  std::string directory;
  std::string run;
  std::string svg;
  std::string timeline;
  std::string csv;
  bool json = false;
};
// Simulates a stored run again. kExitNegative when it is not reproduced or does not read back.
ExitCode RunReplay(CommandContext& context, const ReplayOptions& options);

struct ListOptions {
  std::string section;  // one of kListSections, "" = all
  bool json = false;
};
inline const std::vector<std::string> kListSections = {"experiments", "scenarios", "controllers", "searches",
                                                       "disturbances"};
ExitCode RunList(CommandContext& context, const ListOptions& options);

}  // namespace gauntlet::master
