// The task partitioning scenario (thesis 6.1 to 6.4; spec 4.1): robots bring items from a source to a nest 4
// m away below a lamp, and hand them over to one another on the way. Fitness is the number of items dropped
// in the nest (thesis 6.3.2, equation 5.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/food_source.h"
#include "controllers/common/nest_and_food.h"
#include "controllers/partitioning/partitioning_controller.h"
#include "controllers/partitioning/partitioning_record.h"
#include "sim/arena/spawn.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

// Where robots begin.
enum class StartMode : std::uint8_t {
  kSteadyState = 0,  // half of them at the centre, half at the source, in Neighbourhood (thesis 6.4.1)
  kNest = 1,         // all in the nest, in Explore (thesis 6.4.2)
};

struct PartitioningSettings : NestAndFood {
  StartMode start = StartMode::kSteadyState;
  sim::Vec2 lamp_offset = sim::Vec2::Zero();  // m, of the lamp from the nest's centre
  double lamp_height = 0.0;                   // m
  double lamp_intensity = 0.0;                // at least; larger where the arena needs it
};

// 1: no item in the nest (thesis 6.1.1).
std::span<const FailureType> PartitioningFailureTypes();

class PartitioningScenario : public sim::Scenario {
 public:
  // `test_case` is valid for the requirements of the scenario; its number of robots and its spawn area
  // override the settings. `seed` decides the start poses.
  PartitioningScenario(const sim::TestCase& test_case, const PartitioningSettings& settings,
                       const PartitionerSettings& robot, std::uint64_t seed);

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  std::span<const sim::Light> lights() const override { return lights_; }
  double FloorGrey(const sim::Vec2& point) const override;
  // Errors besides "no-room-to-spawn": "swarm-size", "nest-and-food", "light-outside",
  // "partition-length", "start-mode".
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override;
  bool Finished(const sim::Observer& observer) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  Status CheckSettings() const;
  Result<std::vector<sim::Pose>> StartPoses() const;
  bool InNest(const sim::Vec2& point) const;
  void DropItems(const sim::Interaction& interaction);
  void HandItemsOver(const sim::Interaction& interaction);
  bool MayHandOver(const sim::Interaction& interaction, sim::RobotIndex giver,
                   sim::RobotIndex receiver) const;
  bool Trapped(const sim::Observer& observer, sim::RobotIndex robot) const;
  std::vector<sim::Annotation> Annotate(const sim::Observer& observer,
                                        const std::vector<bool>& trapped) const;

  sim::Arena arena_;
  PartitioningSettings settings_;
  PartitionerSettings robot_;
  std::uint64_t seed_;
  sim::Vec2 nest_;
  sim::Vec2 food_;
  std::optional<sim::Rectangle> spawn_area_;  // of the test case
  std::vector<sim::Light> lights_;            // above the nest, at the source
  FoodSource source_;
  PartitioningRecord record_;
  std::vector<std::uint8_t> carrying_;  // per robot
  std::vector<sim::Tick> last_served_;  // per robot: newest tick in the source's queue
};

}  // namespace gauntlet::controllers
