#include "controllers/common/food_source.h"

namespace gauntlet::controllers {

FoodSource::FoodSource(const FoodSourceSettings& settings, int robots) : settings_(settings) {
  queue_.reserve(static_cast<std::size_t>(robots));
}

bool FoodSource::Demands(sim::RobotIndex robot, std::span<const sim::RobotState> robots,
                         const sim::Grippers& grippers) const {
  if (!grippers.Closed(robot) || grippers.Holds(robot)) return false;
  const sim::Vec2 offset = robots[static_cast<std::size_t>(robot)].position() - settings_.position;
  return offset.squaredNorm() <= settings_.reach * settings_.reach;
}

std::optional<sim::RobotIndex> FoodSource::Serve(sim::Tick tick, std::span<const sim::RobotState> robots,
                                                 sim::Grippers& grippers) {
  std::erase_if(queue_, [&](const Customer& customer) { return !Demands(customer.robot, robots, grippers); });
  for (sim::RobotIndex robot = 0; robot < static_cast<sim::RobotIndex>(robots.size()); ++robot) {
    if (Demands(robot, robots, grippers) && !Waits(robot)) queue_.push_back({robot, tick});
  }
  if (queue_.empty() || tick < next_item_ || tick - queue_.front().arrival < settings_.pickup) {
    return std::nullopt;
  }
  const sim::RobotIndex served = queue_.front().robot;
  queue_.erase(queue_.begin());
  grippers.Give(served);
  next_item_ = tick + settings_.interval;
  return served;
}

bool FoodSource::Waits(sim::RobotIndex robot) const {
  return std::any_of(queue_.begin(), queue_.end(),
                     [&](const Customer& customer) { return customer.robot == robot; });
}

}  // namespace gauntlet::controllers
