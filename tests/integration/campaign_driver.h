// Runs the real binaries as a user would and reads their JSON.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/random/random_stream.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {

std::string GauntletPath();
std::string WorkerPath();
// The library that tests/support/fault_shim.cc makes, for LD_PRELOAD.
std::string FaultShimPath();

// The program and its arguments.
std::vector<std::string> GauntletCommand(const std::vector<std::string>& arguments);
// gauntlet ARGUMENTS..., waited for.
ProcessResult Gauntlet(const std::vector<std::string>& arguments,
                       std::chrono::seconds deadline = std::chrono::seconds(300));
std::unique_ptr<Process> StartGauntlet(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& environment = {});

// A whole file; "" when it cannot be read.
std::string ReadFile(const std::string& path);

// A campaign small enough for a test: a few dozen to a few hundred runs.
struct SmallCampaign {
  std::string name = "flocking";  // of the tests
  int population = 8;
  int generations = 4;
  std::string seed = "7";
  std::string experiment = "flocking";
  std::vector<std::string> settings;  // key=value, as given to --set
  std::string case_file = {};         // evaluated instead, when there is one
};

inline void PrintTo(const SmallCampaign& campaign, std::ostream* os) {
  *os << campaign.name;
}
// Foraging of the same size: the runs are cut short, because 20 robots over 800 s take 0.1 s each; under a
// sanitizer, where they take seconds, once more.
SmallCampaign SmallForaging();
// Task partitioning, likewise.
SmallCampaign SmallPartitioning();
// Flocking searched steadily, without generations.
SmallCampaign SmallSteadyState();
// Flocking searched for many different failures.
SmallCampaign SmallArchive();
// Random cases of flocking, so many short runs that states are saved on the way.
SmallCampaign SmallRandom();
// Settings of flocking, fitted to two targets; its runs are cut short.
SmallCampaign SmallFit();
// A program of a few milliseconds, programs/course.toml. With `noise`, its runs are not reproducible.
SmallCampaign SmallCommand(bool noise = false);
// A given case with many replicates.
SmallCampaign SmallEvaluation();
// "COMMAND EXPERIMENT --dir DIR ..." with everything that makes this campaign what it is.
std::vector<std::string> CampaignArguments(const std::string& command, const SmallCampaign& campaign,
                                           const std::string& dir);
// The command that starts the campaign.
std::vector<std::string> EvolveArguments(const SmallCampaign& campaign, const std::string& dir, int workers);

// `show DIR --json`, parsed; a null value (and a test failure) when it does not answer with one JSON
// document.
nlohmann::json Show(const std::string& dir);
// state_hash of `show`.
std::string StateHash(const std::string& dir);
// The state_hash of an undisturbed `evolve` with two workers; computed once per campaign.
const std::string& UndisturbedHash(const SmallCampaign& campaign);

// A time from 1 ms to `longest`.
std::chrono::milliseconds RandomTime(sim::RandomStream& random, std::chrono::milliseconds longest);
// Sends SIGKILL to one of the processes below `ancestor`; false when there is none.
bool KillADescendant(const Process& ancestor, sim::RandomStream& random);

// Kills the master of the campaign at `moments` random moments (SIGKILL) and resumes it each time; finally
// lets it end. Returns how many of the kills hit a running master.
int EvolveThroughMasterKills(const SmallCampaign& campaign, const std::string& dir, int workers, int kills,
                             std::uint64_t seed, std::chrono::milliseconds longest_life);

// Runs the campaign while random workers and runners are killed (SIGKILL) until it ends. Returns how many
// were killed.
int EvolveThroughWorkerKills(const SmallCampaign& campaign, const std::string& dir, int workers, int kills,
                             std::uint64_t seed, std::chrono::milliseconds between_kills);

}  // namespace gauntlet::testing_support
