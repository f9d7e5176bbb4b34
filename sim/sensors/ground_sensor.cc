#include "sim/sensors/ground_sensor.h"

#include <algorithm>
#include <vector>

#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr double kFarthestPlace = 0.07;  // m from the robot's centre; more than of any motor ground sensor

class MotorGroundSensors final : public Sensor {
 public:
  explicit MotorGroundSensors(std::size_t robots) : floors_(robots) {}

  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    const BodyFrame& self = scene.robots[static_cast<std::size_t>(robot)];
    Floor& floor = floors_[static_cast<std::size_t>(robot)];
    if ((self.position - floor.from).squaredNorm() >= floor.holds * floor.holds) {
      floor = {.from = self.position,
               .holds = std::max(0.0, scene.surroundings.FloorHolds(self.position) - kFarthestPlace),
               .grey = scene.surroundings.FloorGrey(self.position)};
      if (floor.holds == 0.0) {
        readings.motor_ground = SenseGround(self, kMotorGroundPlaces, scene.surroundings);
        return;
      }
    }
    readings.motor_ground.fill(floor.grey);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.motor_ground.fill(0.0); }
  void Disturb(const Scene& /*scene*/, RobotIndex /*robot*/, DeviceErrors& errors,
               SensorReadings& readings) override {
    errors.AddTo(readings.motor_ground);
  }

 private:
  // What a robot stands on until it has moved so far.
  struct Floor {
    Vec2 from = Vec2::Zero();
    double holds = 0.0;  // m
    double grey = 0.0;
  };

  std::vector<Floor> floors_;
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

std::unique_ptr<Sensor> MakeMotorGroundSensors(const Arena& /*arena*/, std::span<const RobotSensors> robots) {
  return std::make_unique<MotorGroundSensors>(robots.size());
}

std::unique_ptr<Sensor> MakeBaseGroundSensors(const Arena& /*arena*/,
                                              std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<BaseGroundSensors>();
}

}  // namespace gauntlet::sim
