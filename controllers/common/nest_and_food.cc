#include "controllers/common/nest_and_food.h"

#include <algorithm>

namespace gauntlet::controllers {
namespace {

constexpr sim::Tick kFoodWindow = 120 * sim::kTicksPerSecond;

}  // namespace

sim::Vec2 NestOf(const NestAndFood& settings) {
  return {0.0, -settings.nest_food_distance / 2.0};
}

sim::Vec2 FoodOf(const NestAndFood& settings) {
  return {0.0, settings.nest_food_distance / 2.0};
}

sim::ArenaRequirements RequirementsOf(const NestAndFood& settings) {
  sim::ArenaRequirements requirements;
  requirements.start = NestOf(settings);
  requirements.goal = FoodOf(settings);
  requirements.clearance = settings.clearance;
  return requirements;
}

bool StandsInNest(const sim::SensorReadings& readings) {
  constexpr double kNestGrey = 0.5;  // the floor is nest where it is darker
  return std::all_of(readings.motor_ground.begin(), readings.motor_ground.end(),
                     [](double grey) { return grey < kNestGrey; });
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
