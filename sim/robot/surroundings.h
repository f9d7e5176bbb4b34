// What surrounds the robots besides bodies: lights, radio beacons, the colour of the floor. A scenario
// provides it; sensors read it.
#pragma once

#include <span>

#include "sim/geometry/vec2.h"
#include "sim/robot/controller.h"

namespace gauntlet::sim {

// A lamp. With an intensity, light sensors read it; with a colour, cameras see it as a blob. Both is allowed.
struct Light {
  Vec2 position = Vec2::Zero();  // m
  double height = 0.5;           // m above the floor, at least 0
  double intensity = 0.0;        // as in ARGoS: seen up to 2.5 m times this; 0 = no light sensor reads it
  Color color = Color::kBlack;   // black = no camera sees it
  bool occludable = true;        // false: nothing hides it
};

// Something that is no robot and sends the same message in every tick, for instance the nest.
struct RadioBeacon {
  Vec2 position = Vec2::Zero();                    // m
  double range = foot_bot::kRangeAndBearingRange;  // m, horizontal
  Payload payload{};
};

// The spans are read in every tick after Scenario::Interact: their contents may change from tick to tick,
// their sizes must not grow.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  virtual std::span<const Light> lights() const { return {}; }
  virtual std::span<const RadioBeacon> radio_beacons() const { return {}; }
  // Grey of the floor at a point, 0 = black, 1 = white.
  virtual double FloorGrey(const Vec2& /*point*/) const { return 1.0; }
  // How far around a point the floor is as grey as there, m, now and to the end of the run: at most. 0 says
  // nothing.
  virtual double FloorHolds(const Vec2& /*point*/) const { return 0.0; }
};

}  // namespace gauntlet::sim
