// The prey: the informed robot that the birds follow. It knows the map and its own place through Headquarters
// (thesis 3.3.3.2, 4.3.1), ignores the birds and sees nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/observer.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

struct PreySettings {
  double speed = 0.0;            // m/s, v_prey
  double turn_rate = 0.0;        // rad/s, at most
  double drive_within = 0.0;     // rad; with a larger heading error it turns on the spot
  double waypoint_radius = 0.0;  // m; a waypoint is passed at this distance
  double inflation = 0.0;        // m kept from obstacles where the way allows it
};

// The way of the prey (basic Theta*), planned with `inflation`, or, when that closes every way, with the
// inflation that valid arenas are passable for. Empty when there is no path at all.
std::vector<sim::Vec2> PlanPreyPath(const sim::Arena& arena, const sim::Vec2& start, const sim::Vec2& goal,
                                    double inflation);

// Follows the path and stops at its end.
class PreyController : public sim::Controller {
 public:
  // `headquarters` outlives the controller; `self` is the robot's own index; `path` is not empty.
  PreyController(const sim::Headquarters& headquarters, sim::RobotIndex self, std::vector<sim::Vec2> path,
                 const PreySettings& settings);

  sim::DeviceSet Devices() const override { return sim::Device::kWheels | sim::Device::kLeds; }
  void Step(const sim::ControlStep& step) override;

 private:
  const sim::Headquarters& headquarters_;
  sim::RobotIndex self_;
  std::vector<sim::Vec2> path_;
  PreySettings settings_;
  std::size_t next_ = 0;  // the waypoint it drives to; path_.size() when it has arrived
};

}  // namespace gauntlet::controllers
