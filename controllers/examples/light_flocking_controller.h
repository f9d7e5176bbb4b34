// An example to copy: flocking towards a light as ARGoS' sample controller does it. Robots attract and repel
// each other by a Lennard-Jones force and are drawn by a light; the sum is a direction and a speed.
#pragma once

#include <span>

#include "sim/robot/controller.h"

namespace gauntlet::controllers::light_flocking {

struct LightFlockingSettings {
  double target_distance = 0.0;  // m, where flockmates neither attract nor repel
  double gain = 0.0;             // m^2/s, of the force
  int exponent = 0;              // of the force
  double cutoff = 0.0;           // blobs nearer than this times the target distance count
  double max_speed = 0.0;        // m/s
  double light_share = 0.0;      // pull of the light relative to max_speed
  double no_turn = 0.0;          // rad, up to here: straight on
  double soft_turn = 0.0;        // rad, down to here a turn on the spot goes on
  double hard_turn = 0.0;        // rad, beyond it: turn on the spot, which ends at soft_turn
};

// How a robot turns at present. The switching is the one that ARGoS' recorded swarms show: with it their
// first second is reproduced to 1e-5 m; a soft turn that only begins above soft_turn misses it by
// centimetres.
enum class Turning { kNone, kSoft, kHard };

// The velocity that the flockmates ask for, in the robot's frame, at most max_speed long: the mean over the
// red blobs within the cutoff of gain / d * ((target / d)^exponent - (target / d)^(2 exponent)) towards the
// blob (generalised Lennard-Jones: negative, that is away, when nearer than the target). Zero when there is
// none.
sim::Vec2 FlockingVelocity(std::span<const sim::Blob> blobs, const LightFlockingSettings& settings);

// The velocity that the light asks for: along the sum of the light readings, light_share * max_speed long.
// Zero in the dark.
sim::Vec2 LightVelocity(std::span<const double> readings, const LightFlockingSettings& settings);

// Not for sharing between threads.
class LightFlockingController : public sim::Controller {
 public:
  explicit LightFlockingController(const LightFlockingSettings& settings) : settings_(settings) {}

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;
  Turning turning() const { return turning_; }

 private:
  // Sets the wheels so that the robot comes to move with `velocity` (its own frame).
  void Drive(const sim::Vec2& velocity, sim::Actuators& actuators);

  LightFlockingSettings settings_;
  Turning turning_ = Turning::kNone;
};

}  // namespace gauntlet::controllers::light_flocking
