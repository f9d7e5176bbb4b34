// A partitioning robot alone, fed with hand-made readings.
#pragma once

#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "controllers/partitioning/partitioning_registry.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {

inline constexpr Lamp kNestLamp = {1.0, 3.0};

inline PartitionerSettings PartitionerWith(const ParameterTable<PartitionerSettings>& table,
                                           const sim::Parameters& given = {}) {
  PartitionerSettings settings = table.Read(*ResolveParameters(table.infos(), given));
  settings.wander.turn_probability = 0.0;  // never turns by itself
  return settings;
}

// What a ring of sensors reads of a lamp at `distance` m on the floor.
inline std::array<double, sim::foot_bot::kLightSensors> LampReadings(const Lamp& lamp, double distance,
                                                                     double bearing) {
  std::array<double, sim::foot_bot::kLightSensors> readings{};
  const double slant = std::sqrt(distance * distance + lamp.height * lamp.height);
  for (int i = 0; i < sim::foot_bot::kLightSensors; ++i) {
    const double angle = std::fabs(sim::WrapAngle(sim::ProximityBearing(i) - bearing));
    if (angle >= sim::kPi / 2.0) continue;
    readings[static_cast<std::size_t>(i)] =
        std::exp(-2.0 * slant / lamp.intensity) * (1.0 - angle / (sim::kPi / 2.0));
  }
  return readings;
}

// Hand-made readings of one tick; angles in degrees.
struct PartitionScene {
  std::vector<sim::Blob> blobs;
  std::vector<sim::Message> messages;
  sim::SensorReadings readings;
  BodyMotion motion;  // what the odometer tells

  PartitionScene() { readings.motor_ground.fill(1.0); }
  PartitionScene& Nest(double distance, double bearing = 0.0) {
    readings.light = LampReadings(kNestLamp, distance, bearing * sim::kDegree);
    return *this;
  }
  PartitionScene& Source(double range, double bearing = 0.0) { return See(range, bearing, kSourceColor); }
  PartitionScene& Carrier(double range, double bearing = 0.0) { return See(range, bearing, kCarrierColor); }
  PartitionScene& See(double range, double bearing, sim::Color color) {
    blobs.push_back(sim::Blob::At(range, bearing * sim::kDegree, color));
    return *this;
  }
  PartitionScene& Hear(double range, HandoverStep step, int self, int partner = 0, double bearing = 0.0) {
    const PartitionMessage message{.from_robot = true,
                                   .state = step == HandoverStep::kRequest
                                                ? PartitioningState::kExplore
                                                : PartitioningState::kWaitForTransfer,
                                   .step = step,
                                   .self = static_cast<std::uint8_t>(self),
                                   .partner = static_cast<std::uint8_t>(partner)};
    messages.push_back(sim::Message::At(range, bearing * sim::kDegree, Encode(message)));
    return *this;
  }
  PartitionScene& InNest() {
    readings.motor_ground.fill(0.0);
    return *this;
  }
  PartitionScene& HalfInNest() {
    readings.motor_ground = {0.0, 1.0, 1.0, 0.0};
    return *this;
  }
  PartitionScene& Carrying() {
    readings.holding_item = true;
    return *this;
  }
  // The body moved by that much, m, straight ahead.
  PartitionScene& Moved(double forward) {
    motion.shift = {forward, 0.0};
    return *this;
  }
  // The sensor at `bearing`, one of +-7.5, +-22.5, ..., hits something at `distance` m.
  PartitionScene& Hit(double bearing, double distance) {
    const auto sensor = (std::lround((bearing - 7.5) / 15.0) + 24) % 24;
    readings.proximity[static_cast<std::size_t>(sensor)] = ProximityReadingAt(distance);
    readings.proximity_hits |= 1u << sensor;
    return *this;
  }
};

class PartitionRobot {
 public:
  using State = PartitioningState;
  static constexpr std::uint8_t kNumber = 3;

  explicit PartitionRobot(const PartitionerSettings& settings, State state = State::kExplore)
      : controller_(settings, {.robot = kNumber,
                               .pickup_distance = 0.36,
                               .nest_lamp = kNestLamp,
                               .starts_in_relay = state == State::kNeighbourhood,
                               .odometer = [motion = motion_] { return *motion; }}) {}

  State Step(PartitionScene scene) {
    scene.readings.blobs = scene.blobs;
    scene.readings.range_and_bearing = scene.messages;
    *motion_ = scene.motion;
    sim::RandomStream random(7, sim::StreamPurpose::kTest, 0, static_cast<std::uint32_t>(tick_));
    controller_.Step({tick_++, scene.readings, actuators_, random});
    return controller_.state();
  }
  State Step(const PartitionScene& scene, int ticks) {
    for (int i = 1; i < ticks; ++i) Step(scene);
    return Step(scene);
  }
  double forward() const { return (actuators_.left_wheel + actuators_.right_wheel) / 2.0; }
  double turn() const {
    return (actuators_.right_wheel - actuators_.left_wheel) / sim::foot_bot::kWheelDistance;
  }
  bool stands() const { return actuators_.left_wheel == 0.0 && actuators_.right_wheel == 0.0; }
  bool gripper_closed() const { return actuators_.gripper_closed; }
  sim::Color beacon() const { return actuators_.beacon; }
  PartitionMessage says() const { return DecodePartition(actuators_.message); }
  const PartitioningController& controller() const { return controller_; }

 private:
  std::shared_ptr<BodyMotion> motion_ = std::make_shared<BodyMotion>();
  PartitioningController controller_;
  sim::Actuators actuators_;
  sim::Tick tick_ = 0;
};

}  // namespace gauntlet::controllers
