// The flocking scenario (thesis 4.1): birds and one prey start in the corner (+,+), the prey walks
// to the corner (-,-), the birds follow it without losing anyone.
//
// The birds are those of the controller under test; the prey belongs to the scenario. Robot order: birds 0 ..
// n-1, then the prey as robot n.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/flocking/failure_classifier.h"
#include "controllers/flocking/prey_controller.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct FlockingSettings {
  int birds = 0;
  int min_swarm = 0;             // fewer birds than this with the prey at the end: total failure
  sim::Tick tick_limit = 0;      // the run is judged then if the prey has not arrived
  double corner_distance = 0.0;  // m from the walls' centre lines to the start and to the goal
  double spawn_side = 0.0;       // m, side of the square in the corner that birds start in
  double goal_radius = 0.0;      // m
  double camera_range = 0.0;     // m, half side of the square a bird sees
  PreySettings prey;
  SplitRule split;
};

// The lights that robots carry: what a bird's camera tells it.
inline constexpr sim::Color kBirdColor = sim::Color::kRed;
inline constexpr sim::Color kPreyColor = sim::Color::kBlue;

class FlockingScenario : public sim::Scenario {
 public:
  // `test_case` is valid for the requirements of the scenario; its number of robots and its spawn area
  // override the settings. `seed` decides the start poses.
  FlockingScenario(const sim::TestCase& test_case, const FlockingSettings& settings, ControllerFactory birds,
                   std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  bool Finished(const sim::Observer& observer) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  sim::RobotIndex prey() const { return settings_.birds; }
  bool Arrived(const sim::Observer& observer) const;

  sim::Arena arena_;
  FlockingSettings settings_;
  ControllerFactory birds_;
  std::uint64_t seed_;
  sim::Vec2 start_;
  sim::Vec2 goal_;
  sim::Rectangle spawn_area_;
  std::vector<sim::Vec2> prey_path_;
};

}  // namespace gauntlet::controllers
