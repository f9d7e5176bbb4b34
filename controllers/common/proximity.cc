#include "controllers/common/proximity.h"

#include <cstddef>

#include "sim/geometry/trigonometry.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

const std::array<sim::Vec2, sim::foot_bot::kProximitySensors>& ProximityDirections() {
  static const auto directions = [] {
    std::array<sim::Vec2, sim::foot_bot::kProximitySensors> result;
    for (int i = 0; i < sim::foot_bot::kProximitySensors; ++i) {
      result[static_cast<std::size_t>(i)] = sim::UnitVector(sim::ProximityBearing(i));
    }
    return result;
  }();
  return directions;
}

double ProximityReadingAt(double distance) {
  constexpr double kSaturated = 0.009889556;  // m
  return distance < kSaturated ? 1.0 : 0.0100527 / (distance + 0.000163144);
}

}  // namespace gauntlet::controllers
