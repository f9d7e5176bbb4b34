#include "controllers/flocking/prey_controller.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "base/check.h"
#include "controllers/common/steering.h"
#include "controllers/flocking/flocking_scenario.h"
#include "sim/arena/path_planner.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr double kEndRadius = 0.01;  // m; it stops this near to the end of its path

// Everything that a path depends on, by its bits: a path has the sign of a zero.
using PlanKey = std::vector<std::uint64_t>;

PlanKey KeyOf(const sim::Arena& arena, const sim::Vec2& start, const sim::Vec2& goal, double inflation) {
  PlanKey key = {std::bit_cast<std::uint64_t>(inflation)};
  const auto add = [&](const sim::Vec2& pair) {
    for (const double value : {pair.x(), pair.y()}) key.push_back(std::bit_cast<std::uint64_t>(value));
  };
  add(start);
  add(goal);
  for (const sim::OrientedBox& box : arena.boxes()) {
    add(box.center);
    add(box.half_extents);
    add(box.axis);
  }
  return key;
}

// The paths planned last. A case is simulated again and again: replicates, individuals that survive, copies
// of them.
class PlannedPaths {
 public:
  // Nothing when it has not been planned or was forgotten.
  const std::vector<sim::Vec2>* Find(const PlanKey& key) const {
    const auto same = [&](const Plan& plan) { return plan.key == key; };
    const auto found = std::ranges::find_if(plans_, same);
    return found == plans_.end() ? nullptr : &found->path;
  }
  void Keep(PlanKey key, const std::vector<sim::Vec2>& path) {
    plans_[next_++ % plans_.size()] = {std::move(key), path};
  }

 private:
  struct Plan {
    PlanKey key;
    std::vector<sim::Vec2> path;
  };
  std::array<Plan, 64> plans_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<sim::Vec2> PlanPreyPath(const sim::Arena& arena, const sim::Vec2& start, const sim::Vec2& goal,
                                    double inflation) {
  // Remembering changes no path, only when it is computed.
  thread_local PlannedPaths planned;
  PlanKey key = KeyOf(arena, start, goal, inflation);
  if (const auto* path = planned.Find(key)) return *path;
  std::vector<sim::Vec2> path = sim::PlanPath(sim::OccupancyGrid(arena, inflation), start, goal);
  if (path.empty() && inflation != sim::OccupancyGrid::kDefaultInflation) {
    path = sim::PlanPath(sim::OccupancyGrid(arena, sim::OccupancyGrid::kDefaultInflation), start, goal);
  }
  planned.Keep(std::move(key), path);
  return path;
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
