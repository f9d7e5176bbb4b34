#include "sim/sensors/light_sensor.h"

#include <algorithm>
#include <cmath>

#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr double kLightReach = 2.5;  // of distance / intensity
constexpr double kSpacing = 2.0 * kPi / foot_bot::kLightSensors;

void Shine(double brightness, double bearing, LightReadings& readings) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    double angle = std::abs((static_cast<double>(i) + 0.5) * kSpacing - bearing);  // in [0, 3 pi)
    if (angle > kPi) angle = std::abs(2.0 * kPi - angle);
    if (angle < kPi / 2.0) readings[i] += brightness * (1.0 - angle / (kPi / 2.0));
  }
}

class LightSensors final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    readings.light = SenseLight(scene.robots, robot, scene.surroundings.lights(), scene.occluders);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.light.fill(0.0); }
  void Disturb(const Scene& /*scene*/, RobotIndex /*robot*/, DeviceErrors& errors,
               SensorReadings& readings) override {
    errors.AddTo(readings.light);
  }
};

}  // namespace

LightReadings SenseLight(std::span<const BodyFrame> robots, RobotIndex self, std::span<const Light> lights,
                         const Occluders& occluders) {
  LightReadings readings{};
  const BodyFrame& frame = robots[static_cast<std::size_t>(self)];
  for (const Light& light : lights) {
    if (!(light.intensity > 0.0)) continue;
    const Vec2 offset = light.position - frame.position;
    const double distance = std::sqrt(offset.squaredNorm() + light.height * light.height) / light.intensity;
    if (distance > kLightReach) continue;
    if (light.occludable) {
      const Point3 foot = {frame.position, 0.0};
      const Point3 lamp = {light.position, light.height};
      if (occluders.BoxBetween(foot, lamp) || BodyBetween(robots, foot, lamp, self, -1)) continue;
    }
    Shine(Exp(-2.0 * distance), WrapAngle(AngleOf(offset) - frame.heading), readings);
  }
  for (double& reading : readings) reading = std::min(reading, 1.0);
  return readings;
}

std::unique_ptr<Sensor> MakeLightSensors(const Arena& /*arena*/, std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<LightSensors>();
}

}  // namespace gauntlet::sim
