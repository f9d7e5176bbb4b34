// A swarm starts packed in the corner (+,+) and has to spread until it covers as much of the arena as it can.
#pragma once

#include <cstdint>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/open_arena.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::coverage {

struct CoverageScenarioSettings : OpenArena {
  double spawn_side = 0.0;       // m, side of the square in the corner that robots start in
  double coverage_radius = 0.0;  // m, a robot covers what it sees up to here
  double least_covered = 0.0;    // share; a swarm that covers less failed
};

// What a robot says that stands by its own rules. One that never says so is stuck when it does not move.
inline constexpr sim::Payload kStandingMessage = {1};

// The number of a type of failure, 0 to 53: where the centroid of the largest hole is (PlaceOf); whether it
// has less than 4, up to 8 or more m^2; and whether there is a jam. All limits are chosen.
int FailureTypeOf(int place, double hole_area, bool jam);
const FailureTypes& CoverageFailureTypes();

class CoverageScenario : public sim::Scenario {
 public:
  CoverageScenario(const sim::TestCase& test_case, const CoverageScenarioSettings& settings,
                   ControllerFactory robots, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override;
  bool Finished(const sim::Observer&) override { return false; }
  // Fitness: share of the reachable cells covered, mean over the last 30 s. Robots that are stuck are lost:
  // in the last minute they neither moved nor stood by their own rules. A jam: three or more are stuck, or
  // stand within 0.30 m of one another.
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  sim::TestCase test_case_;
  sim::Arena arena_;
  CoverageScenarioSettings settings_;
  ControllerFactory robots_;
  std::uint64_t seed_;
  sim::Rectangle area_;                // the start
  std::vector<sim::Tick> last_stood_;  // per robot; -1 = never
};

}  // namespace gauntlet::controllers::coverage
