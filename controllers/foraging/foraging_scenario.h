// The foraging scenario (thesis 5.1 to 5.4.1): robots start around the nest, take items from a source of food
// 4 m away and drop them in the nest until the time is over. Fitness is the number of items dropped there
// (equation 5.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/nest_and_food.h"
#include "controllers/foraging/radio_message.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

// The food's light.
inline constexpr sim::Color kFoodColor = sim::Color::kGreen;

struct ForagingSettings : NestAndFood {
  bool bodies_block_radio = false;
};

// 1: no path of beacons ever, 2: no item in the nest, 3: both (thesis 5.4.2).
const std::vector<FailureType>& ForagingFailureTypes();

class ForagingScenario : public NestAndFoodScenario {
 public:
  ForagingScenario(const sim::TestCase& test_case, const ForagingSettings& settings,
                   ControllerFactory controller, std::uint64_t seed);

  std::span<const sim::Light> lights() const override { return {&food_light_, 1}; }
  std::span<const sim::RadioBeacon> radio_beacons() const override { return {&nest_beacon_, 1}; }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  bool IsBeacon(sim::RobotIndex robot, sim::Tick tick) const;
  void FindFirstPath(const sim::Observer& observer);
  // Without a path of beacons, by a controller that should have laid one.
  bool NoPath() const { return controller_.traits.marks_path && first_path_ < 0; }
  std::vector<sim::Annotation> Annotate(const sim::Observer& observer,
                                        const std::vector<bool>& trapped) const;

  bool bodies_block_radio_;
  std::uint64_t seed_;
  sim::Rectangle spawn_area_;
  bool spawn_disc_;
  sim::Light food_light_;
  sim::RadioBeacon nest_beacon_;
  sim::Tick first_path_ = -1;
  std::vector<sim::Vec2> first_chain_;
};

}  // namespace gauntlet::controllers
