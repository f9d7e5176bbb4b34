#include "controllers/common/nest_and_food_scenario.h"

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "controllers/common/stillness.h"

namespace gauntlet::controllers {
namespace {

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`

}  // namespace

NestAndFoodScenario::NestAndFoodScenario(const sim::TestCase& test_case, const NestAndFood& site,
                                         ControllerFactory controller,
                                         std::span<const std::string_view> states)
    : arena_(test_case),
      site_(site),
      nest_(NestOf(site)),
      food_(FoodOf(site)),
      controller_(std::move(controller)),
      source_({food_, site.pickup_distance, site.pickup, site.serving_interval},
              test_case.robots.value_or(site.robots)),
      states_(states) {
  site_.robots = test_case.robots.value_or(site.robots);
}

Status NestAndFoodScenario::CheckSite(std::string_view food) const {
  if (site_.robots < 1 || site_.robots > kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(site_.robots) + " robots; from 1 to " +
                        std::to_string(kMaxRobots) + " can be tested");
  }
  if (site_.nest_food_distance <= site_.nest_radius) {
    return InvalidInput("nest-and-food: the " + std::string(food) + " is " +
                        NumberText(site_.nest_food_distance) +
                        " m from the nest's centre (nest_food_distance), inside the nest (nest_radius " +
                        NumberText(site_.nest_radius) + " m)");
  }
  return Ok{};
}

sim::RobotSetup NestAndFoodScenario::SetUp(const sim::Pose& pose, ControllerContext context) const {
  context.communication_range = site_.communication_range;
  context.pickup_distance = site_.pickup_distance;
  sim::RobotSetup robot;
  robot.pose = pose;
  robot.camera_range = site_.camera_range;
  robot.radio_range = site_.communication_range;
  robot.controller = controller_.create(std::move(context));
  return robot;
}

void NestAndFoodScenario::Begin(std::uint8_t state) {
  const auto robots = static_cast<std::size_t>(site_.robots);
  states_.Begin(site_.robots, site_.tick_limit, state);
  items_.Begin(site_.tick_limit);
  last_at_rest_.assign(robots, -1);
  carrying_.assign(robots, 0);
}

bool NestAndFoodScenario::InNest(const sim::Vec2& point) const {
  return (point - nest_).squaredNorm() <= site_.nest_radius * site_.nest_radius;
}

void NestAndFoodScenario::DropItems(const sim::Interaction& interaction) {
  const auto robots = interaction.observer.Latest();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    if (!interaction.grippers.Holds(robot) || interaction.grippers.Closed(robot)) continue;
    interaction.grippers.Take(robot);
    items_.Drop(interaction.observer.last_tick(), InNest(robots[i].position()));
  }
}

void NestAndFoodScenario::ServeItems(const sim::Interaction& interaction) {
  const sim::Observer& observer = interaction.observer;
  if (source_.Serve(observer.last_tick(), observer.Latest(), interaction.grippers)) items_.Take();
}

void NestAndFoodScenario::Record(const sim::Interaction& interaction, sim::RobotIndex robot,
                                 std::uint8_t state, bool at_rest) {
  const auto index = static_cast<std::size_t>(robot);
  states_.Add(state);
  if (at_rest || source_.Waits(robot)) last_at_rest_[index] = interaction.observer.last_tick();
  carrying_[index] = interaction.grippers.Holds(robot) ? 1 : 0;
}

bool NestAndFoodScenario::Trapped(const sim::Observer& observer, sim::RobotIndex robot) const {
  const sim::Tick first = observer.last_tick() - site_.trapped_window;
  if (first < 0 || last_at_rest_[static_cast<std::size_t>(robot)] >= first) return false;
  return KeptWithin(observer, robot, site_.trapped_window, site_.trapped_radius);
}

sim::Outcome NestAndFoodScenario::Judge(const sim::Observer& observer) const {
  sim::Outcome outcome;
  outcome.fitness = items_.dropped();
  for (sim::RobotIndex robot = 0; robot < site_.robots; ++robot) {
    outcome.lost.push_back(Trapped(observer, robot));
  }
  outcome.failure.total = items_.dropped() == 0;
  return outcome;
}

NestAndFoodScenario::Metrics NestAndFoodScenario::ItemMetrics() const {
  return items_.Metrics(static_cast<int>(std::count(carrying_.begin(), carrying_.end(), 1)));
}

std::vector<sim::Annotation> NestAndFoodScenario::Places() const {
  return {{"disc", "nest", {nest_}, site_.nest_radius, -1, {}},
          {"disc", "food", {food_}, site_.food_radius, -1, {}}};
}

sim::Annotation NestAndFoodScenario::TrappedMark(sim::RobotIndex robot, sim::Tick since) const {
  const bool carries = carrying_[static_cast<std::size_t>(robot)] != 0;
  return {"trapped", carries ? "trapped with an item" : "trapped", {}, 0.0, since, {robot}};
}

}  // namespace gauntlet::controllers
