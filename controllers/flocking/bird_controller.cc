#include "controllers/flocking/bird_controller.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "base/bits.h"
#include "controllers/common/proximity.h"
#include "controllers/common/steering.h"
#include "controllers/flocking/flocking_scenario.h"
#include "controllers/parameters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::Vec2;

// A proximity ray that passes a beacon nearer than this, within this distance of it, hit that robot's body
// and not an obstacle. A fixed window of angles would turn touching neighbours, who subtend
// 60 degrees, into obstacles and freeze pairs.
constexpr double kBodyMiss = 0.10;          // m from the ray to the beacon
constexpr double kBodyDistance = 0.30;      // m from centre to centre
constexpr double kCosFrontOfCatchUp = 0.5;  // of 60 degrees
constexpr double kShortestSum = 1e-3;       // a shorter sum of unit vectors or of readings points nowhere

bool IsRobot(const sim::Blob& blob) {
  return blob.color == kBirdColor || blob.color == kPreyColor;
}

// Where a bird wants to go: to the prey, else to the mean position of the visible birds, else nowhere.
class Goal {
 public:
  explicit Goal(std::span<const sim::Blob> blobs) {
    for (const sim::Blob& blob : blobs) {
      if (blob.color != kPreyColor) continue;
      known_ = true;
      sum_ = blob.position;
      return;
    }
    for (const sim::Blob& blob : blobs) {
      if (blob.color != kBirdColor) continue;
      known_ = true;
      sum_ += blob.position;
    }
  }

  // Not when nobody is visible.
  bool known() const { return known_; }
  // Of any length; only when known.
  const Vec2& Way() const { return sum_; }
  bool InFront(const sim::Blob& blob) const { return !known() || blob.position.dot(sum_) >= 0.0; }
  // Unit vector; straight ahead when nobody is visible, or when birds evenly around leave no direction.
  Vec2 Direction() const {
    const double length = std::sqrt(sum_.dot(sum_));
    return length > 0.0 ? Vec2(sum_ / length) : Vec2(1.0, 0.0);
  }

 private:
  bool known_ = false;
  Vec2 sum_ = Vec2::Zero();  // of the positions that it aims at
};

// Positions of the robots near enough to be what a proximity ray hits, in the robot's frame.
class NearRobots {
 public:
  explicit NearRobots(std::span<const sim::Blob> blobs) {
    for (const sim::Blob& blob : blobs) {
      if (count_ == positions_.size()) break;
      if (blob.range < kBodyDistance && IsRobot(blob)) {
        positions_[count_++] = blob.position;
      }
    }
  }
  bool HitBy(const Vec2& ray) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (std::fabs(sim::Cross(ray, positions_[i])) <= kBodyMiss && ray.dot(positions_[i]) >= 0.0)
        return true;
    }
    return false;
  }

 private:
  // No more than 16 discs of 0.085 m find room with their centres within 0.30 m.
  std::array<Vec2, 16> positions_;
  std::size_t count_ = 0;
};

// Where obstacles push: minus the sum of the readings along their bearings, over every ray that did not hit a
// robot. `ahead` tells whether one of them is within 90 degrees of the heading.
struct ObstaclePush {
  Vec2 away = Vec2::Zero();
  bool ahead = false;
};

ObstaclePush FindObstacles(const sim::SensorReadings& readings, double least_reading) {
  ObstaclePush push;
  if (readings.proximity_hits == 0) return push;
  const NearRobots robots(readings.blobs);
  const auto& directions = ProximityDirections();
  ForEachBit(readings.proximity_hits, [&](std::size_t i) {
    const double reading = readings.proximity[i];
    if (reading < least_reading || robots.HitBy(directions[i])) return;
    push.away -= reading * directions[i];
    push.ahead = push.ahead || directions[i].x() > 0.0;
  });
  return push;
}

Vec2 WayPastObstacles(const Vec2& away_sum, const Goal& goal) {
  const double length = std::sqrt(away_sum.dot(away_sum));
  const Vec2 away = length > kShortestSum ? Vec2(away_sum / length) : Vec2(Vec2::Zero());
  const Vec2 sum = goal.Direction() + away;
  return sum.dot(sum) < kShortestSum * kShortestSum ? sim::LeftOf(away) : sum;
}

// The nearest robot in front and on the side of the goal that is closer than the separation distance.
const sim::Blob* FindTooNear(std::span<const sim::Blob> blobs, double distance, const Goal& goal) {
  const sim::Blob* nearest = nullptr;
  for (const sim::Blob& blob : blobs) {
    if (blob.range >= distance || blob.position.x() < 0.0 || !IsRobot(blob)) continue;
    if (nearest != nullptr && blob.range >= nearest->range) continue;
    if (!goal.InFront(blob)) continue;
    nearest = &blob;
  }
  return nearest;
}

// Whether a robot is visible in front and the nearest such robot is farther than `distance`.
bool IsBehind(std::span<const sim::Blob> blobs, double distance) {
  bool somebody = false;
  for (const sim::Blob& blob : blobs) {
    if (blob.position.x() < kCosFrontOfCatchUp * blob.range || !IsRobot(blob)) continue;
    if (blob.range <= distance) return false;
    somebody = true;
  }
  return somebody;
}

}  // namespace

BirdController::BirdController(const BirdSettings& settings)
    : settings_(settings),
      // At the sensor's full range every reading counts, whatever the last bit of the formula says.
      least_obstacle_reading_(settings.obstacle_distance >= sim::foot_bot::kProximityRange
                                  ? 0.0
                                  : ProximityReadingAt(settings.obstacle_distance)),
      straight_edge_(sim::UnitVector(settings.straight_within)),
      wander_(settings.wander) {}

sim::DeviceSet BirdController::Devices() const {
  return sim::Device::kWheels | sim::Device::kLeds | sim::Device::kProximity |
         sim::Device::kOmnidirectionalCamera;
}

void BirdController::Step(const sim::ControlStep& step) {
  step.actuators.beacon = kBirdColor;
  if (turn_ticks_ > 0) {
    --turn_ticks_;
    step.actuators.Drive(turn_.forward, turn_.turn);
    return;
  }

  const std::span<const sim::Blob> blobs = step.readings.blobs;
  Reactions reactions{settings_.speed, settings_.turn_rate, settings_.straight_within,
                      settings_.turning_speed_factor};
  if (settings_.catch_up_gain != 1.0 && IsBehind(blobs, settings_.catch_up_distance)) {
    reactions.speed *= settings_.catch_up_gain;
    reactions.turn_rate *= settings_.catch_up_gain;
  }

  const Goal goal(blobs);
  const ObstaclePush obstacles = FindObstacles(step.readings, least_obstacle_reading_);
  // The rules in falling priority; the first that applies decides, anew in every tick.
  DriveCommand command;
  bool wanders = false;
  if (obstacles.ahead) {
    command = React(WayPastObstacles(obstacles.away, goal), straight_edge_, reactions);
    command.forward *= settings_.obstacle_speed_factor;
  } else if (const sim::Blob* near = FindTooNear(blobs, settings_.separation_distance, goal)) {
    command = React(Vec2(-near->position), straight_edge_, reactions);
    if (std::fabs(near->position.y()) > near->position.x()) {
      command.forward = reactions.speed * reactions.turning_speed_factor;
    }
  } else if (goal.known()) {
    command = React(goal.Way(), straight_edge_, reactions);
  } else {
    wanders = true;
    command = React(wander_.Next(step.random), reactions);
    wander_.Turned(command.turn * sim::kTickSeconds);
  }
  if (!wanders || command.turn == 0.0) wander_.Reset();
  if (!wanders && command.turn != 0.0 && settings_.turn_angle > 0.0) {
    turn_ = command;
    turn_ticks_ = ToTicks(settings_.turn_angle / std::fabs(command.turn)) - 1;  // this tick is the first
  }

  step.actuators.Drive(command.forward, command.turn);
}

}  // namespace gauntlet::controllers
