// Losses of power at random moments, and what they may cost.
#pragma once

#include <chrono>
#include <cstdint>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

struct DurabilityReport {
  int kills = 0;         // that hit a living master
  int acknowledged = 0;  // runs acknowledged before some kill
  int leased_again = 0;  // acknowledged runs that were leased again: none
  int simulated = 0;     // leases answered
  int runs = 0;          // of the campaign
};

// Evolves under the sync-loss shim with one scripted worker, which remembers what was acknowledged, while the
// master is killed `kills` times, each within `longest_life` of its first lease. Ends with the campaign
// finished; expects the undisturbed state_hash.
DurabilityReport EvolveThroughPowerLosses(const SmallCampaign& campaign, const std::string& dir, int kills,
                                          std::uint64_t seed, std::chrono::milliseconds longest_life);

struct MassacreReport {
  int master_kills = 0;
  int worker_kills = 0;
  int runs = 0;
  int evaluations = 0;             // runs that began, by the workers' own log
  int evaluated_after_stored = 0;  // that began although their result was stored: none
};

// Evolves with a local pool of workers that log every run they begin. Random workers and runners are killed,
// `worker_kills` in all, and the master `master_kills` times, until both are used up or the search has ended.
// A run takes `run` at least, so that how many kills a campaign can take does not depend on the machine: the
// masters live (longest_life / 2 + longest_life / 6) on average.
MassacreReport EvolveThroughMassacre(const SmallCampaign& campaign, const std::string& dir, int workers,
                                     int master_kills, int worker_kills, std::uint64_t seed,
                                     std::chrono::milliseconds longest_life, std::chrono::milliseconds run);

}  // namespace gauntlet::testing_support
