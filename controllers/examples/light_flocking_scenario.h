// An example to copy: robots start in the corner (+,+) and flock to a light in the corner (-,-).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/corners.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::light_flocking {

struct LightFlockingScenarioSettings : CornerToCorner {
  int robots = 0;
  double light_height = 0.0;     // m
  double light_intensity = 0.0;  // of ARGoS' light model
};

// The light that a robot carries from the start.
inline constexpr sim::Color kFlockmateColor = sim::Color::kRed;

class LightFlockingScenario : public sim::Scenario {
 public:
  static constexpr double kStopped = 0.02;              // m; who moved less has stopped
  static constexpr sim::Tick kStoppedTicks = 300;       // over these last ticks
  static constexpr sim::Tick kStoppedSampleTicks = 20;  // looked at this often

  LightFlockingScenario(const sim::TestCase& test_case, const LightFlockingScenarioSettings& settings,
                        ControllerFactory robots, std::uint64_t seed);
  // From these start poses instead; for comparisons with recorded swarms.
  LightFlockingScenario(const sim::TestCase& test_case, const LightFlockingScenarioSettings& settings,
                        ControllerFactory robots, std::vector<sim::Pose> start_poses);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  std::span<const sim::Light> lights() const override { return {&light_, 1}; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  bool Finished(const sim::Observer&) override { return false; }
  // Fitness: how much nearer to the light the mean robot is at the end than it was at the start, relative to
  // the start; 0 when it is farther. A total failure is a swarm that did not come half the way.
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  Result<std::vector<sim::Pose>> StartPoses() const;

  sim::Arena arena_;
  LightFlockingScenarioSettings settings_;
  ControllerFactory robots_;
  std::uint64_t seed_ = 0;
  sim::Vec2 start_;
  sim::Light light_;
  sim::Rectangle spawn_area_;
  std::vector<sim::Pose> given_poses_;
};

}  // namespace gauntlet::controllers::light_flocking
