// The flocking scenario (thesis 4.1): birds and one prey start in the corner (+,+), the prey walks
// to the corner (-,-), the birds follow it without losing anyone.
//
// The birds are those of the controller under test; the prey belongs to the scenario. Robot order: birds 0 ..
// n-1, then the prey as robot n.
#pragma once

#include <cstdint>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/corners.h"
#include "controllers/flocking/failure_classifier.h"
#include "controllers/flocking/prey_controller.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct FlockingSettings : CornerToCorner {
  int birds = 0;
  int min_swarm = 0;         // fewer birds than this with the prey at the end: total failure
  double goal_radius = 0.0;  // m
  PreySettings prey;
  SplitRule split;

  // Where the prey turns on its way, and with it the flock: the corners of its planned path; its start and
  // its goal when it goes straight on.
  std::vector<sim::Vec2> Passages(const sim::TestCase& test_case) const;
};

// The lights that robots carry: what a bird's camera tells it.
inline constexpr sim::Color kBirdColor = sim::Color::kRed;
inline constexpr sim::Color kPreyColor = sim::Color::kBlue;

class FlockingScenario : public sim::Scenario {
 public:
  FlockingScenario(const sim::TestCase& test_case, const FlockingSettings& settings, ControllerFactory birds,
                   std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  // The prey has arrived.
  bool Finished(const sim::Observer& observer) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  sim::RobotIndex prey() const { return settings_.birds; }

  sim::Arena arena_;
  FlockingSettings settings_;
  ControllerFactory birds_;
  std::uint64_t seed_;
  sim::Vec2 start_;
  sim::Vec2 goal_;
  sim::Rectangle spawn_area_;
  std::vector<sim::Pose> start_poses_;  // that the test case gives; empty: the seed decides
  std::vector<sim::Vec2> prey_path_;
};

}  // namespace gauntlet::controllers
