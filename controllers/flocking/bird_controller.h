// The bird: follows the prey, else its flockmates, by sight alone (thesis 4.3, 4.7.2). The improved bird is
// the original one with a threshold more.
#pragma once

#include "controllers/common/random_walk.h"
#include "controllers/common/steering.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

struct BirdSettings {
  double speed = 0.0;                 // m/s, v_b
  double turn_rate = 0.0;             // rad/s, omega_t
  double straight_within = 0.0;       // rad
  double turning_speed_factor = 0.0;  // forward speed while turning
  double turn_angle = 0.0;         // rad; a turn goes on that far once begun; 0 = is decided anew each tick
  double obstacle_distance = 0.0;  // m beyond the body, d_obs
  double obstacle_speed_factor = 0.0;  // forward speed beside an obstacle
  double separation_distance = 0.0;    // m between centres, d_sep
  RandomWalkParameters wander;
  // Thesis 4.7.2, of the improved bird only: with the nearest robot in front farther than that it hurries.
  double catch_up_distance = 0.0;  // m, d_new
  double catch_up_gain = 1.0;      // factor on speed and turn rate; 1 = never hurries
};

// One bird. Sees red birds and the blue prey with the camera, obstacles with the proximity ring; remembers
// nothing but the angle of its random walk and, with a turn angle, the turn that it has begun. Not for
// sharing between threads.
class BirdController : public sim::Controller {
 public:
  explicit BirdController(const BirdSettings& settings);

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;

 private:
  BirdSettings settings_;
  double least_obstacle_reading_;
  sim::Vec2 straight_edge_;  // to the left of what counts as straight ahead
  RandomWalk wander_;
  DriveCommand turn_;         // the turn that was begun
  sim::Tick turn_ticks_ = 0;  // that it still goes on
};

}  // namespace gauntlet::controllers
