#include "controllers/flocking/prey_controller.h"

#include <utility>

#include "base/check.h"
#include "controllers/common/steering.h"
#include "controllers/flocking/flocking_scenario.h"
#include "sim/arena/path_planner.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr double kEndRadius = 0.01;  // m; it stops this near to the end of its path

}  // namespace

std::vector<sim::Vec2> PlanPreyPath(const sim::Arena& arena, const sim::Vec2& start, const sim::Vec2& goal,
                                    double inflation) {
  std::vector<sim::Vec2> path = sim::PlanPath(sim::OccupancyGrid(arena, inflation), start, goal);
  if (!path.empty() || inflation == sim::OccupancyGrid::kDefaultInflation) return path;
  return sim::PlanPath(sim::OccupancyGrid(arena, sim::OccupancyGrid::kDefaultInflation), start, goal);
}

PreyController::PreyController(const sim::Headquarters& headquarters, sim::RobotIndex self,
                               std::vector<sim::Vec2> path, const PreySettings& settings)
    : headquarters_(headquarters), self_(self), path_(std::move(path)), settings_(settings) {
  GAUNTLET_CHECK(!path_.empty(), "the prey has no path");
}

void PreyController::Step(const sim::ControlStep& step) {
  const sim::Pose pose = headquarters_.PoseOf(self_);
  while (next_ < path_.size()) {
    const double radius = next_ + 1 < path_.size() ? settings_.waypoint_radius : kEndRadius;
    if ((path_[next_] - pose.position).squaredNorm() >= radius * radius) break;
    ++next_;
  }

  DriveCommand command;
  if (next_ < path_.size()) {
    const double bearing = sim::WrapAngle(sim::AngleOf(path_[next_] - pose.position) - pose.heading);
    command = TurnThenDrive(bearing, settings_.speed, settings_.turn_rate, settings_.drive_within);
  }
  step.actuators.beacon = kPreyColor;
  step.actuators.Drive(command.forward, command.turn);
}

}  // namespace gauntlet::controllers
