// The task partitioning scenario (thesis 6.1 to 6.4): robots bring items from a source to a nest 4
// m away below a lamp, and hand them over to one another on the way. Fitness is the number of items dropped
// in the nest (thesis 6.3.2, equation 5.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/nest_and_food.h"
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
  Lamp lamp;                                  // at least so intense; more where the arena needs it
};

// 1: no item in the nest (thesis 6.1.1).
const std::vector<FailureType>& PartitioningFailureTypes();

// The lights of the source and of a robot that offers its item.
inline constexpr sim::Color kSourceColor = sim::Color::kYellow;
inline constexpr sim::Color kCarrierColor = sim::Color::kGreen;

class PartitioningScenario : public NestAndFoodScenario {
 public:
  PartitioningScenario(const sim::TestCase& test_case, const PartitioningSettings& settings,
                       ControllerFactory controller, std::uint64_t seed);

  std::span<const sim::Light> lights() const override { return lights_; }
  // Errors besides "no-room-to-spawn": those of CheckSite and of the controller, "light-outside",
  // "start-mode".
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override;
  void Interact(const sim::Interaction& interaction) override;
  sim::Outcome Evaluate(const sim::Observer& observer) override;

 private:
  Status CheckSettings() const;
  Result<std::vector<sim::Pose>> StartPoses() const;
  void HandItemsOver(const sim::Interaction& interaction);
  bool MayHandOver(const sim::Interaction& interaction, sim::RobotIndex giver,
                   sim::RobotIndex receiver) const;
  std::vector<sim::Annotation> Annotate(const sim::Observer& observer,
                                        const std::vector<bool>& trapped) const;

  StartMode start_;
  std::uint64_t seed_;
  std::optional<sim::Rectangle> spawn_area_;
  std::array<sim::Light, 2> lights_;  // the lamp above the nest, the source
  PartitioningRecord record_;
};

}  // namespace gauntlet::controllers
