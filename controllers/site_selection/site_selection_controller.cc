#include "controllers/site_selection/site_selection_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/common/potential_field.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::site_selection {
namespace {

using sim::Device;
using sim::Vec2;

// Greys halfway between what they tell apart: the worst site has 0.5.
constexpr double kSiteBelow = (0.5 + kNestGrey) / 2.0;
constexpr double kNestBelow = (kNestGrey + 1.0) / 2.0;

// Chosen but for the last one (Buchanan's dps code).
constexpr SteeringThresholds kSteering = {.straight = 10.0 * sim::kDegree, .hard = 70.0 * sim::kDegree};
constexpr PotentialFieldSettings kField = {.least_push = 0.15};
constexpr RandomWalkParameters kWalk = {.turn_probability = 0.02, .turn_limit = 115.0 * sim::kDegree};

// Of a detour.
constexpr double kFollowReading = 0.25;            // 4 cm off the obstacle
constexpr double kFollowGain = 2.0;                // bearing's slope per reading too much or too little
constexpr double kLostTurn = 30.0 * sim::kDegree;  // round the end of an obstacle

// Exponentially distributed, in whole ticks.
sim::Tick DrawTime(double mean, sim::RandomStream& random) {
  return ToTicks(-mean * sim::Log(1.0 - random.Uniform()));
}

Vec2 LightDirection(const sim::SensorReadings& readings) {
  Vec2 sum = Vec2::Zero();
  const auto& directions = ProximityDirections();
  for (std::size_t i = 0; i < readings.light.size(); ++i) sum += readings.light[i] * directions[i];
  return sum;
}

}  // namespace

sim::Payload Encode(const SiteMessage& message) {
  return {static_cast<std::uint8_t>(1 + static_cast<int>(message.state)),
          static_cast<std::uint8_t>(message.opinion), static_cast<std::uint8_t>(message.aloud ? 1 : 0),
          message.sender};
}

std::optional<SiteMessage> DecodeSiteMessage(const sim::Payload& payload) {
  if (payload[0] < 1 || payload[0] > 4 || payload[1] > 1) return std::nullopt;
  return SiteMessage{static_cast<SiteState>(payload[0] - 1), static_cast<Site>(payload[1]), payload[2] == 1,
                     payload[3]};
}

SiteSelectionController::SiteSelectionController(const SiteSelectionSettings& settings,
                                                 const ControllerContext& context)
    : settings_(settings),
      number_(static_cast<std::uint8_t>(context.robot)),
      walk_(kWalk),
      opinion_(context.robot % 2 == 0 ? Site::kA : Site::kB) {
  heard_.reserve(static_cast<std::size_t>(settings.group));
}

sim::DeviceSet SiteSelectionController::Devices() const {
  return Device::kWheels | Device::kProximity | Device::kLight | Device::kMotorGround |
         Device::kRangeAndBearing;
}

sim::DeviceSet SiteSelectionController::Attention(bool /*holding_item*/) const {
  sim::DeviceSet used = Device::kWheels | Device::kProximity | Device::kMotorGround;
  if (Travels() || strayed_) used = used | Device::kLight;
  if (Listens()) used = used | Device::kRangeAndBearing;
  return used;
}

void SiteSelectionController::Begin(sim::Actuators& actuators) {
  actuators.message = Encode({state_, opinion_, false, number_});
}

void SiteSelectionController::Step(const sim::ControlStep& step) {
  ChangeState(step);
  const DriveCommand command = Move(step);
  step.actuators.Drive(command.forward, command.turn);
  const bool aloud = state_ == SiteState::kTell && step.random.Chance(settings_.tell_chance);
  step.actuators.message = Encode({state_, opinion_, aloud, number_});
}

void SiteSelectionController::ChangeState(const sim::ControlStep& step) {
  const double grey = *std::ranges::max_element(step.readings.motor_ground);  // all of it is this dark
  const bool at_site = grey < kSiteBelow;
  const bool in_nest = !at_site && grey < kNestBelow;
  if (at_site) quality_ = std::clamp(1.0 - 2.0 * grey, 0.0, 1.0);
  const SiteState before = state_;
  switch (state_) {
    case SiteState::kGo:
      if (at_site) {
        state_ = SiteState::kSurvey;
        left_ = DrawTime(settings_.survey_time, step.random);
      }
      break;
    case SiteState::kSurvey:
      if (--left_ <= 0) state_ = SiteState::kBack;
      break;
    case SiteState::kBack:
      if (in_nest) {
        state_ = SiteState::kTell;
        left_ = DrawTime(settings_.tell_time * quality_, step.random);
        heard_.clear();
      }
      break;
    case SiteState::kTell:
      if (Listens()) Hear(step.readings.range_and_bearing);
      if (--left_ <= 0) {
        opinion_ = Majority(step.random);
        state_ = SiteState::kGo;
      }
      break;
  }
  strayed_ = (state_ == SiteState::kSurvey && !at_site) || (state_ == SiteState::kTell && !in_nest);
  if (!strayed_) home_ = 0.0;
  if (state_ != before) held_ = detour_left_ = 0;
}

void SiteSelectionController::Hear(std::span<const sim::Message> messages) {
  for (const sim::Message& message : messages) {
    const auto said = DecodeSiteMessage(message.payload);
    if (!said || !said->aloud) continue;
    std::erase_if(heard_, [&](const SiteMessage& heard) { return heard.sender == said->sender; });
    if (heard_.size() == static_cast<std::size_t>(settings_.group)) heard_.erase(heard_.begin());
    heard_.push_back(*said);
  }
}

Site SiteSelectionController::Majority(sim::RandomStream& random) const {
  int lead = 1;  // of the own opinion
  for (const SiteMessage& heard : heard_) lead += heard.opinion == opinion_ ? 1 : -1;
  if (lead == 0) return random.Chance(0.5) ? Site::kA : Site::kB;
  return (lead > 0) == (opinion_ == Site::kA) ? Site::kA : Site::kB;
}

double SiteSelectionController::AlongLight(const sim::SensorReadings& readings, const Vec2& light) {
  const double to_site = opinion_ == Site::kA ? 1.0 : -1.0;
  if (state_ == SiteState::kGo) return to_site;
  if (state_ == SiteState::kBack) return -to_site;
  if (!strayed_) return 0.0;
  if (state_ == SiteState::kSurvey) return to_site;
  // On the edge of the nest, the floor is darker where it is. Two sensors look ahead, two behind.
  const auto& grey = readings.motor_ground;
  const double ahead = grey[0] + grey[3];
  const double behind = grey[1] + grey[2];
  if (ahead != behind && !light.isZero(0.0)) home_ = (light.x() > 0.0) == (ahead < behind) ? 1.0 : -1.0;
  return home_;
}

DriveCommand SiteSelectionController::Move(const sim::ControlStep& step) {
  const ProximitySum near = SumProximity(step.readings.proximity);
  const Vec2 away = Repulsion(near, kField);
  const bool avoids = !away.isZero(0.0);
  if (settings_.patience > 0 && Travels()) KeepPatience(avoids, step.random);
  if (detour_left_ > 0) return FollowObstacle(near);

  const Vec2 light = LightDirection(step.readings);
  const Vec2 goal = AlongLight(step.readings, light) * light;
  if (goal.isZero(0.0)) {
    if (!avoids) return walk_.Drive(settings_.speed, kSteering, step.random);
    walk_.Reset();
    return FollowField(0.0, away, settings_.speed, kSteering);
  }
  walk_.Reset();
  const double bearing = sim::AngleOf(goal);
  return avoids ? FollowField(bearing, away, settings_.speed, kSteering)
                : Steer(bearing, settings_.speed, kSteering);
}

void SiteSelectionController::KeepPatience(bool avoids, sim::RandomStream& random) {
  if (detour_left_ > 0) {
    --detour_left_;
    return;
  }
  held_ = avoids ? held_ + 1 : std::max(0, held_ - 1);
  if (held_ < settings_.patience) return;
  held_ = 0;
  detour_left_ = settings_.detour_ticks;
  side_ = random.Chance(0.5) ? 1.0 : -1.0;
}

DriveCommand SiteSelectionController::FollowObstacle(const ProximitySum& near) const {
  const double length = std::sqrt(near.sum.squaredNorm());
  if (length == 0.0) return Steer(-side_ * kLostTurn, settings_.speed, kSteering);
  const Vec2 to_obstacle = near.sum / length;
  const Vec2 along = side_ * Vec2(-to_obstacle.y(), to_obstacle.x());
  const Vec2 way = along + kFollowGain * (kFollowReading - near.largest) * to_obstacle;
  return Steer(sim::AngleOf(way), settings_.speed, kSteering);
}

}  // namespace gauntlet::controllers::site_selection
