// The bird: follows the prey, else its flockmates, by sight alone (thesis 4.3, 4.7.2; spec 2.3, 2.4). The
// improved bird is the original one with a threshold more.
#pragma once

#include <optional>

#include "controllers/common/random_walk.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

// Thesis 4.7.2: a bird whose nearest robot in front is farther than a threshold moves and turns faster.
struct CatchUp {
  double distance = 0.0;  // m, d_new
  double gain = 1.0;      // factor on speed and turn rate
};

struct BirdSettings {
  double speed = 0.0;                  // m/s, v_b
  double turn_rate = 0.0;              // rad/s, omega_t
  double straight_within = 0.0;        // rad
  double turning_speed_factor = 0.0;   // forward speed while turning
  double obstacle_distance = 0.0;      // m beyond the body, d_obs
  double obstacle_speed_factor = 0.0;  // forward speed beside an obstacle
  double separation_distance = 0.0;    // m between centres, d_sep
  RandomWalkParameters wander;
  std::optional<CatchUp> catch_up;  // the improved bird only
};

// The rules in falling priority; the first that applies decides, anew in every tick.
enum class BirdRule { kObstacle, kSeparate, kChase, kFlock, kWander };

// One bird. Sees red birds and the blue prey with the camera, obstacles with the proximity ring; remembers
// nothing but the angle of its random walk. Not for sharing between threads.
class BirdController : public sim::Controller {
 public:
  static constexpr sim::Color kBirdColor = sim::Color::kRed;
  static constexpr sim::Color kPreyColor = sim::Color::kBlue;

  explicit BirdController(const BirdSettings& settings);

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;
  // The rule that decided the last step.
  BirdRule last_rule() const { return last_rule_; }

 private:
  BirdSettings settings_;
  double least_obstacle_reading_;
  sim::Vec2 straight_edge_;  // to the left of what counts as straight ahead
  RandomWalk wander_;
  BirdRule last_rule_ = BirdRule::kWander;
};

}  // namespace gauntlet::controllers
