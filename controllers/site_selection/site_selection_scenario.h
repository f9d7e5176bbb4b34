// A swarm in a nest in the middle of the arena chooses between a site on either side, A towards the light and
// B away from it. One is better; which one is drawn from the seed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/state_log.h"
#include "controllers/site_selection/site_selection_controller.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::site_selection {

// Nest and sites reach from wall to wall along y.
struct SiteSelectionScenarioSettings {
  int robots = 0;
  sim::Tick tick_limit = 0;
  double nest_half_width = 0.0;  // m along x; robots start in the square in the middle of this half side
  double site_depth = 0.0;       // m along x from the centre line of the wall
  double light_distance = 0.0;   // m beyond that line
  double worse_quality = 0.0;    // of the worse site; the better one has 1
  int better_side = 0;           // 1 = A is better, 2 = B is, 0 = the seed decides
  double radio_range = 0.0;      // m
  double open_share = 0.0;       // of the empty arena that obstacles must leave connected with the nest

  // Ways from the nest's centre to the centres of both sites, and an arena that is still open.
  sim::ArenaRequirements Requirements(const sim::TestCase& test_case) const;
};

// Total failures by their numbers: outcome (wrong consensus, wrong majority) x access (less than 25 %, up to
// 75 %, more of the robots came to the better site) x cause (the way there took more than twice as long, at
// least a quarter is stuck, neither) x better site (A, B).
const FailureTypes& SiteSelectionFailureTypes();

class SiteSelectionScenario : public sim::Scenario {
 public:
  SiteSelectionScenario(const sim::TestCase& test_case, const SiteSelectionScenarioSettings& settings,
                        ControllerFactory robots, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  std::span<const sim::Light> lights() const override { return {&light_, 1}; }
  double FloorGrey(const sim::Vec2& point) const override;
  double FloorHolds(const sim::Vec2& point) const override;
  std::vector<sim::GroundArea> ground_areas() const override { return areas_; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  // Records what robots say.
  void Interact(const sim::Interaction& interaction) override;
  // When all robots have been of one opinion for a minute: nobody can hear another one any more.
  bool Finished(const sim::Observer& observer) override;
  // Fitness: share of the robots that are for the better site, mean of the last 30 s. A total failure is less
  // than a half.
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  sim::Arena arena_;
  sim::TestCase test_case_;
  SiteSelectionScenarioSettings settings_;
  ControllerFactory factory_;
  std::uint64_t seed_;
  Site better_;
  double site_edge_;  // m, x where site A begins; B begins at the opposite
  std::vector<sim::GroundArea> areas_;
  sim::Light light_;
  StateLog log_;
  sim::Tick unanimous_ = 0;  // ticks without a second opinion, up to now
};

}  // namespace gauntlet::controllers::site_selection
