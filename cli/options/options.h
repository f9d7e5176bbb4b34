// Options that several commands share, in groups: a command has the groups that it reads, and no others.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gauntlet {

// The values are texts as they were typed, "" where not given: they are judged by the functions below, whose
// messages say what would be right.

struct MessageOptions {
  bool json = false;
  bool quiet = false;
  bool no_progress = false;
};
// Of a process that is a campaign's master.
struct ServingOptions : MessageOptions {
  std::string audit;
  std::string metrics_port;
};
// Of a process that has workers of its own: on this machine, or as jobs of a cluster.
struct RunningOptions : ServingOptions {
  std::string workers;
  std::vector<std::string> slurm;  // "key=value"; none: on this machine
};
// Where workers connect that come from elsewhere.
struct BindOptions {
  std::string endpoint;
  bool insecure = false;
};
// What is to be run, and where it is kept.
struct ExperimentOptions {
  std::string experiment;
  std::string directory;
  std::string seed;
  std::vector<std::string> sets;
  std::vector<std::string> plugins;        // libraries
  std::vector<std::string> allowed_files;  // of a command, from outside the experiment's folder
};
// How long a genetic search is.
struct SizeOptions {
  std::string generations;
  std::string population;
};
// Several searches in one campaign.
struct SweepOptions {
  std::vector<std::string> sweeps;  // "key=a,b,c"
  std::string seeds;                // "1..20" or "1,5,9"
};
// How a cluster is used.
struct SlurmOptions {
  std::string master;                 // "job" or "here"; "" = as the settings say
  std::vector<std::string> settings;  // "key=value"
};
// Of a new campaign with workers on this machine.
struct LocalOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  RunningOptions running;
  bool dry_run = false;
};

// An option with a value, which the help calls `type`. One with a list is repeated for each value.
CLI::Option* AddValue(CLI::App& command, const char* name, const char* type, std::string& value,
                      const char* help);
void AddValue(CLI::App& command, const char* name, const char* type, std::vector<std::string>& values,
              const char* help);
void AddMessageOptions(CLI::App& command, MessageOptions& options);
void AddServingOptions(CLI::App& command, ServingOptions& options);
void AddRunningOptions(CLI::App& command, RunningOptions& options);
// --slurm, of what may have jobs as workers.
void AddJobsOption(CLI::App& command, RunningOptions& options);
void AddBindOptions(CLI::App& command, BindOptions& options);
void AddExperimentOptions(CLI::App& command, ExperimentOptions& options);
// Libraries of plug-ins.
void AddPluginOption(CLI::App& command, std::vector<std::string>& plugins);
void AddSizeOptions(CLI::App& command, SizeOptions& options);
// `example`: of a sweep, "key=a,b,c".
void AddSweepOptions(CLI::App& command, SweepOptions& options,
                     const std::string& example = "search.population=10,20,40");
void AddSlurmOptions(CLI::App& command, SlurmOptions& options);
// `sizes`: else those of size are not in the command's help, and are read so that it can say why it refuses
// them.
void AddLocalOptions(CLI::App& command, LocalOptions& options, bool sizes);
// The directory of a campaign that exists.
void AddDirectory(CLI::App& command, std::string& directory);

// The cores that this process may use.
int AvailableCores();
// 1 to 1024; "" gives the cores that this process may use.
Result<int> ParseWorkers(const std::string& text);
// A share, 0 to 1; "" gives 0.
Result<double> ParseShare(const std::string& option, const std::string& text);
// 0 (any free one) to 65535; "" gives 0.
Result<int> ParsePort(const std::string& option, const std::string& text);

// A setting of the experiment that an option stands for.
struct ExtraSet {
  std::string option;  // "--cases", for messages; "--sweep KEY=" where the value stands right behind it
  std::string key;     // "search.cases"
  std::string value;

  std::string AsTyped() const;  // "--cases 100"
};
// Those of --generations and --population that were given.
std::vector<ExtraSet> SetsOf(const SizeOptions& options);
// `sets`, and `extra` as "key=value" behind them. Error: one of `extra` contradicts another or one of `sets`.
Result<std::vector<std::string>> JoinSets(const std::vector<std::string>& sets,
                                          const std::vector<ExtraSet>& extra);
// `error`, where it begins with "--set key=value:" of one of `extra`, with the option that was typed instead.
Error AsTyped(Error error, const std::vector<ExtraSet>& extra);
// The experiment with --set, then `extra`, then --seed applied. Error: also when `extra` contradicts a --set.
Result<Experiment> LoadExperimentWith(const ExperimentOptions& options, const std::vector<ExtraSet>& extra);

// "campaigns/flocking-20260131T235959Z", with "-2", "-3", ... when that exists.
std::string DefaultDirectory(const std::string& experiment_name, std::time_t now);
// The directory of a new campaign: `wanted` (--dir), "" for the default. Error: it holds something already.
Result<std::string> NewDirectory(const std::string& wanted, const Experiment& experiment);

}  // namespace gauntlet
