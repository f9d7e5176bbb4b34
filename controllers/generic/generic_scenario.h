// The scenario that users define: any swarm, lights, coloured floor, items, and formulas that say how well
// the swarm did and whether it failed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/generic/definition.h"
#include "controllers/generic/formula.h"
#include "controllers/generic/items.h"
#include "controllers/generic/measures.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::generic {

struct GenericSettings : MeasureSettings {
  sim::Tick tick_limit = 0;
  double spawn_x = 0.0;              // m, centre of the rectangle that robots start in
  double spawn_y = 0.0;              // m
  double spawn_length = 0.0;         // m, along x
  double spawn_width = 0.0;          // m, along y
  double heading = 0.0;              // rad, that robots start with
  double heading_spread = 0.0;       // rad, at most so much to either side of it
  double camera_range = 0.0;         // m, half side of the square that a robot sees
  double communication_range = 0.0;  // m
  double clearance = 0.0;            // m kept free of obstacles around start and goal
  bool end_when_reached = false;

  // Where the swarm starts: the test case's area, or the rectangle.
  sim::Rectangle StartArea(const sim::TestCase& test_case) const;
  // A way from the middle of that area to the goal.
  sim::ArenaRequirements Requirements(const sim::TestCase& test_case) const;
};

class GenericScenario : public sim::Scenario {
 public:
  // The definition has passed ParseDefinition.
  GenericScenario(const sim::TestCase& test_case, const GenericSettings& settings, Definition definition,
                  ControllerFactory robots, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  std::span<const sim::Light> lights() const override { return definition_.lights; }
  double FloorGrey(const sim::Vec2& point) const override;
  std::vector<sim::GroundArea> ground_areas() const override;
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override { items_.Move(interaction); }
  bool Finished(const sim::Observer& observer) override;
  // A total failure is what the formula `failure` says. Trapped robots are lost.
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  // Errors: "swarm-size", "outside-arena".
  Status Check() const;
  Result<std::vector<sim::Pose>> StartPoses() const;
  // Looks whether it is reached by now; a complaint when that cannot be said.
  void LookWhetherReached(const sim::Observer& observer);
  std::vector<sim::Annotation> Places() const;

  sim::Arena arena_;
  GenericSettings settings_;
  Definition definition_;
  ControllerFactory robots_;
  std::uint64_t seed_ = 0;
  sim::Vec2 start_;
  sim::Rectangle spawn_area_;
  std::vector<sim::Pose> start_poses_;  // that the test case gives; empty: the seed decides
  Items items_;
  Measures measures_;
  Formula fitness_;
  Formula failure_;
  std::optional<Formula> reached_;
  std::vector<double> at_the_moment_;  // the values for reached_, kept for their memory
  sim::Tick reached_at_ = -1;
  std::string complaint_;
};

}  // namespace gauntlet::controllers::generic
