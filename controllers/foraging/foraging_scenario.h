// The foraging scenario (thesis 5.1 to 5.4.1; spec 3.1, 3.6): robots start around the nest, take items from a
// source of food 4 m away and drop them in the nest until the time is over. Fitness is the number of items
// dropped there (equation 5.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/food_source.h"
#include "controllers/common/nest_and_food.h"
#include "controllers/common/state_log.h"
#include "controllers/foraging/beacon_chain.h"
#include "controllers/foraging/foraging_controller.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct ForagingSettings : NestAndFood {
  bool bodies_block_radio = false;
  sim::Tick serving_interval = 0;
};

// 1: no path of beacons ever, 2: no item in the nest, 3: both (thesis 5.4.2).
std::span<const FailureType> ForagingFailureTypes();

class ForagingScenario : public sim::Scenario {
 public:
  // `test_case` is valid for the requirements of the scenario; its number of robots and its spawn area
  // override the settings. `seed` decides the start poses.
  ForagingScenario(const sim::TestCase& test_case, const ForagingSettings& settings,
                   const ForagerSettings& forager, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  std::span<const sim::Light> lights() const override { return {&food_light_, 1}; }
  std::span<const sim::RadioBeacon> radio_beacons() const override { return {&nest_beacon_, 1}; }
  double FloorGrey(const sim::Vec2& point) const override;
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override;
  bool Finished(const sim::Observer& observer) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  bool InNest(const sim::Vec2& point) const;
  void DropItems(const sim::Interaction& interaction);
  void RecordStates(const sim::Interaction& interaction);
  ForagingState StateOf(sim::RobotIndex robot, sim::Tick tick) const;
  std::vector<sim::Vec2> BeaconsAt(const sim::Observer& observer, sim::Tick tick) const;
  void FindFirstPath(const sim::Observer& observer);
  bool Trapped(const sim::Observer& observer, sim::RobotIndex robot) const;
  std::vector<sim::Annotation> Annotate(const sim::Observer& observer,
                                        const std::vector<bool>& trapped) const;
  std::vector<std::pair<std::string, double>> Metrics(int trapped) const;

  sim::Arena arena_;
  ForagingSettings settings_;
  ForagerSettings forager_;
  std::uint64_t seed_;
  ChainEnds ends_;
  sim::Rectangle spawn_area_;
  bool spawn_disc_;
  sim::Light food_light_;
  sim::RadioBeacon nest_beacon_;
  FoodSource source_;

  StateLog states_;
  std::vector<sim::Tick> last_at_rest_;  // per robot: newest tick as a beacon or in the source's queue
  std::vector<std::uint8_t> carrying_;   // per robot
  FoodCount food_;
  sim::Tick first_path_ = -1;
  std::vector<sim::Vec2> first_chain_;
};

}  // namespace gauntlet::controllers
