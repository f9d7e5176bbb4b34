#include "controllers/common/nest_and_food.h"

#include <algorithm>

#include "base/number_text.h"
#include "controllers/common/parameters.h"

namespace gauntlet::controllers {
namespace {

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`
constexpr sim::Tick kFoodWindow = 120 * sim::kTicksPerSecond;

}  // namespace

sim::Vec2 NestOf(const NestAndFood& settings) {
  return {0.0, -settings.nest_food_distance / 2.0};
}

sim::Vec2 FoodOf(const NestAndFood& settings) {
  return {0.0, settings.nest_food_distance / 2.0};
}

void ReadNestAndFood(const sim::Parameters& parameters, NestAndFood& settings) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  settings.robots = static_cast<int>(get("robots"));
  settings.tick_limit = ToTicks(get("time_limit"));
  settings.nest_radius = get("nest_radius");
  settings.food_radius = get("food_radius");
  settings.nest_food_distance = get("nest_food_distance");
  settings.spawn_radius = get("spawn_radius");
  settings.communication_range = get("communication_range");
  settings.pickup = ToTicks(get("pickup_time"));
  settings.trapped_window = ToTicks(get("trapped_window"));
  settings.trapped_radius = get("trapped_radius");
}

sim::ArenaRequirements RequirementsOf(const NestAndFood& settings, const sim::Parameters& parameters) {
  sim::ArenaRequirements requirements;
  requirements.start = NestOf(settings);
  requirements.goal = FoodOf(settings);
  requirements.clearance = GetParameter(parameters, "clearance");
  return requirements;
}

Status CheckNestAndFood(const NestAndFood& settings, std::string_view food) {
  if (settings.robots < 1 || settings.robots > kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(settings.robots) + " robots; from 1 to " +
                        std::to_string(kMaxRobots) + " can be tested");
  }
  if (settings.nest_food_distance <= settings.nest_radius) {
    return InvalidInput("nest-and-food: the " + std::string(food) + " is " +
                        NumberText(settings.nest_food_distance) +
                        " m from the nest's centre (nest_food_distance), inside the nest (nest_radius " +
                        NumberText(settings.nest_radius) + " m)");
  }
  return Ok{};
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

}  // namespace gauntlet::controllers
