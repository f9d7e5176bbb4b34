// Options that several commands share, and how their texts become values.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/experiment/experiment.h"

namespace gauntlet::master {

// Texts as they were typed, "" where not given: they are judged by the functions below, whose messages say
// what would be right.
struct CommonOptions {
  std::string experiment;
  std::string directory;
  std::string workers;
  std::string seed;
  std::vector<std::string> sets;
  std::string generations;
  std::string population;
  std::string bind;  // where workers connect; only master and resume
  bool insecure = false;
  std::string audit;
  std::string metrics_port;  // only commands that serve a campaign
  bool as_job = false;       // only resume: the master's job of a submitted campaign
  bool json = false;
  bool quiet = false;
  bool no_progress = false;
};

inline constexpr int kMostWorkers = 1024;

// 1 to kMostWorkers; "" gives the cores that this process may use.
Result<int> ParseWorkers(const std::string& text);
// A share, 0 to 1; "" gives 0.
Result<double> ParseShare(const std::string& option, const std::string& text);
// A decimal number below 2^64, or "random", which draws one from the operating system.
Result<std::uint64_t> ParseSeed(const std::string& text);
// 0 (any free one) to 65535.
Result<int> ParseMetricsPort(const std::string& text);
// Decimal, at least 1.
Result<std::uint64_t> ParseRunId(const std::string& text);

// The experiment with --set, then --generations, --population and --seed, then `extra` ("key=value", with the
// option it came from) applied.
struct ExtraSet {
  std::string option;  // "--cases", for messages
  std::string set;     // "search.cases=100"
};
Result<Experiment> LoadExperimentWith(const CommonOptions& options, const std::vector<ExtraSet>& extra);

// "campaigns/flocking-20260131T235959Z", with "-2", "-3", ... when that exists.
std::string DefaultDirectory(const std::string& experiment_name, std::time_t now);
// The campaign's directory: --dir or the default. Error: it holds something already.
Result<std::string> NewDirectory(const CommonOptions& options, const Experiment& experiment);

}  // namespace gauntlet::master
