#include "controllers/common/nest_and_food.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace gauntlet::controllers {
namespace {

constexpr sim::Tick kFoodWindow = 120 * sim::kTicksPerSecond;

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`

NestAndFood WithRobots(NestAndFood site, std::optional<int> robots) {
  site.robots = robots.value_or(site.robots);
  return site;
}

double UpperMedian(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

double StandardDeviation(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  double squares = 0.0;
  for (const double value : values) squares += (value - sum / count) * (value - sum / count);
  return std::sqrt(squares / count);
}

}  // namespace

bool StandsInNest(const sim::SensorReadings& readings) {
  constexpr double kNestGrey = 0.5;  // the floor is nest where it is darker
  return std::all_of(readings.motor_ground.begin(), readings.motor_ground.end(),
                     [](double grey) { return grey < kNestGrey; });
}

FoodSource::FoodSource(const NestAndFood& site) : site_(site) {
  queue_.reserve(static_cast<std::size_t>(site.robots));
}

bool FoodSource::Demands(sim::RobotIndex robot, std::span<const sim::RobotState> robots,
                         const sim::Grippers& grippers) const {
  if (!grippers.Closed(robot) || grippers.Holds(robot)) return false;
  const sim::Vec2 offset = robots[static_cast<std::size_t>(robot)].position() - site_.Food();
  return offset.squaredNorm() <= site_.pickup_distance * site_.pickup_distance;
}

std::optional<sim::RobotIndex> FoodSource::Serve(sim::Tick tick, std::span<const sim::RobotState> robots,
                                                 sim::Grippers& grippers) {
  std::erase_if(queue_, [&](const Customer& customer) { return !Demands(customer.robot, robots, grippers); });
  for (sim::RobotIndex robot = 0; robot < static_cast<sim::RobotIndex>(robots.size()); ++robot) {
    if (Demands(robot, robots, grippers) && !Waits(robot)) queue_.push_back({robot, tick});
  }
  if (queue_.empty() || tick < next_item_ || tick - queue_.front().arrival < site_.pickup) {
    return std::nullopt;
  }
  const sim::RobotIndex served = queue_.front().robot;
  queue_.erase(queue_.begin());
  grippers.Give(served);
  next_item_ = tick + site_.serving_interval;
  return served;
}

bool FoodSource::Waits(sim::RobotIndex robot) const {
  return std::any_of(queue_.begin(), queue_.end(),
                     [&](const Customer& customer) { return customer.robot == robot; });
}

std::size_t FoodCount::WindowOf(sim::Tick tick) {
  return static_cast<std::size_t>((std::max(tick, 1) - 1) / kFoodWindow);
}

void FoodCount::Begin(sim::Tick tick_limit) {
  dropped_in_window_.assign(Windows(tick_limit), 0);
}

void FoodCount::Drop(sim::Tick tick, bool in_nest) {
  if (!in_nest) {
    ++lost_;
    return;
  }
  ++dropped_;
  ++dropped_in_window_[WindowOf(tick)];
  if (first_item_ < 0) first_item_ = tick;
}

std::vector<std::pair<std::string, double>> FoodCount::Metrics(int carried) const {
  return {{"food_taken", taken_},
          {"food_carried", carried},
          {"food_lost", lost_},
          {"first_item_time", first_item_ < 0 ? -1.0 : first_item_ * sim::kTickSeconds}};
}

void FoodCount::AddWindows(std::vector<std::pair<std::string, double>>& metrics) const {
  for (std::size_t i = 0; i < dropped_in_window_.size(); ++i) {
    metrics.emplace_back("food_window_" + std::to_string(i + 1), dropped_in_window_[i]);
  }
}

sim::Tick StillSince(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius) {
  const auto place = [&](sim::Tick tick) {
    return observer.At(tick)[static_cast<std::size_t>(robot)].position();
  };
  const sim::Tick last = observer.last_tick();
  sim::Vec2 sum = sim::Vec2::Zero();
  for (sim::Tick tick = last - window; tick <= last; ++tick) sum += place(tick);
  const sim::Vec2 center = sum / static_cast<double>(window + 1);
  sim::Tick since = last + 1;
  while (since > 0 && (place(since - 1) - center).squaredNorm() <= radius * radius) --since;
  return since;
}

NestAndFoodScenario::NestAndFoodScenario(const sim::TestCase& test_case, const NestAndFood& site,
                                         ControllerFactory controller,
                                         std::span<const std::string_view> states)
    : arena_(test_case),
      site_(WithRobots(site, test_case.robots)),
      nest_(site.Nest()),
      food_(site.Food()),
      start_poses_(test_case.start_poses),
      controller_(std::move(controller)),
      source_(site_),
      states_(states) {}

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
  context.start = pose;
  context.communication_range = site_.communication_range;
  context.pickup_distance = site_.pickup_distance;
  sim::RobotSetup robot;
  robot.pose = pose;
  robot.camera_range = site_.camera_range;
  robot.radio_range = site_.communication_range;
  robot.controller = controller_.create(context);
  return robot;
}

void NestAndFoodScenario::Begin(std::uint8_t state) {
  const auto robots = static_cast<std::size_t>(site_.robots);
  states_.Begin(site_.robots, site_.tick_limit, state);
  items_.Begin(site_.tick_limit);
  last_at_rest_.assign(robots, -1);
  carrying_.assign(robots, 0);
}

std::vector<sim::GroundArea> NestAndFoodScenario::ground_areas() const {
  return {
      {.name = "nest", .center = nest_, .radius = site_.nest_radius, .half_extents = {0.0, 0.0}, .grey = 0.0},
      {.name = "food",
       .center = food_,
       .radius = site_.food_radius,
       .half_extents = {0.0, 0.0},
       .grey = 1.0}};
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
  return StillSince(observer, robot, site_.trapped_window, site_.trapped_radius) <= first;
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

void AddWhereabouts(const sim::Observer& observer, std::vector<std::pair<std::string, double>>& metrics) {
  std::array<std::vector<double>, 2> places;  // x, y
  for (sim::Tick tick = 0; tick <= observer.last_tick(); tick += sim::kTicksPerSecond) {
    for (const sim::RobotState& robot : observer.At(tick)) {
      places[0].push_back(robot.x);
      places[1].push_back(robot.y);
    }
  }
  const std::array spreads = {StandardDeviation(places[0]), StandardDeviation(places[1])};
  metrics.insert(metrics.end(), {{"median_x", UpperMedian(places[0])},
                                 {"median_y", UpperMedian(places[1])},
                                 {"spread_x", spreads[0]},
                                 {"spread_y", spreads[1]}});
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
