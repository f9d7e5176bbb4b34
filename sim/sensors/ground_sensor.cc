#include "sim/sensors/ground_sensor.h"

namespace gauntlet::sim {
namespace {

class MotorGroundSensors final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    readings.motor_ground =
        SenseGround(scene.robots[static_cast<std::size_t>(robot)], kMotorGroundPlaces, scene.surroundings);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.motor_ground.fill(0.0); }
  void Disturb(const Scene& /*scene*/, RobotIndex /*robot*/, DeviceErrors& errors,
               SensorReadings& readings) override {
    errors.AddTo(readings.motor_ground);
  }
};

class BaseGroundSensors final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    Cut(scene, robot, readings, [] { return 0.0; });
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.base_ground.fill(false); }
  void Disturb(const Scene& scene, RobotIndex robot, DeviceErrors& errors,
               SensorReadings& readings) override {
    Cut(scene, robot, readings, [&] { return errors.Draw(); });
  }

 private:
  // Reads black or white from the grey with the error of each reading.
  template <typename Error>
  static void Cut(const Scene& scene, RobotIndex robot, SensorReadings& readings, const Error& error) {
    const auto grey =
        SenseGround(scene.robots[static_cast<std::size_t>(robot)], kBaseGroundPlaces, scene.surroundings);
    for (std::size_t i = 0; i < grey.size(); ++i) readings.base_ground[i] = grey[i] + error() >= 0.5;
  }
};

}  // namespace

std::unique_ptr<Sensor> MakeMotorGroundSensors(const Arena& /*arena*/,
                                               std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<MotorGroundSensors>();
}

std::unique_ptr<Sensor> MakeBaseGroundSensors(const Arena& /*arena*/,
                                              std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<BaseGroundSensors>();
}

}  // namespace gauntlet::sim
