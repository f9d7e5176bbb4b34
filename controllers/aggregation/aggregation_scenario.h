// Robots begin anywhere in the arena and are to gather in one cluster.
#pragma once

#include <cstdint>
#include <vector>

#include "controllers/aggregation/aggregation_metrics.h"
#include "controllers/behaviour.h"
#include "controllers/common/open_arena.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::aggregation {

// The light by which robots see one another.
inline constexpr sim::Color kBeaconColor = sim::Color::kRed;

struct AggregationScenarioSettings : OpenArena {
  double camera_range = 0.0;  // m, half side of the square that a robot sees
  double link_range = 0.0;    // m between centres: robots that are nearer and in sight are one cluster
};

// The ways to fail, told apart by where the largest cluster is, how large the next one is, and whether one
// has the other in sight.
inline constexpr int kFailureTypes = kPlaces * 2 * 2;
int FailureTypeOf(int place, double second_share, bool in_sight);
std::string FailureLabel(int type);
std::string FailureDivision(int type);  // its part without the place

class AggregationScenario : public sim::Scenario {
 public:
  AggregationScenario(const sim::TestCase& test_case, const AggregationScenarioSettings& settings,
                      ControllerFactory robots, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  bool Finished(const sim::Observer& /*observer*/) override { return false; }
  // Fitness: share of the robots in the largest cluster, mean over the last 30 s, looked at once per second,
  // so that no lucky moment decides. A total failure is a swarm without a majority: fitness below 0.5.
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  Groups GroupsAt(const sim::Observer& observer, sim::Tick tick);

  sim::TestCase test_case_;
  sim::Arena arena_;
  AggregationScenarioSettings settings_;
  ControllerFactory robots_;
  std::uint64_t seed_;
  Clusters clusters_;
};

}  // namespace gauntlet::controllers::aggregation
