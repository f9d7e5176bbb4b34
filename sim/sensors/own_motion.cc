// What a robot knows of itself: its pose in the world and how its wheels turn (ARGoS positioning and
// differential_steering).
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

class PositioningSensors final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    readings.pose = scene.poses[static_cast<std::size_t>(robot)];
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.pose = {}; }
};

class WheelEncoders final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    readings.wheels = scene.wheels.empty() ? WheelSpeeds{} : scene.wheels[static_cast<std::size_t>(robot)];
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.wheels = {}; }
};

}  // namespace

std::unique_ptr<Sensor> MakePositioningSensors(const Arena& /*arena*/,
                                               std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<PositioningSensors>();
}

std::unique_ptr<Sensor> MakeWheelEncoders(const Arena& /*arena*/, std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<WheelEncoders>();
}

}  // namespace gauntlet::sim
