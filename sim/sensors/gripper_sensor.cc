#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

class GripperSensor final : public Sensor {
 public:
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    readings.holding_item = scene.grippers.Holds(robot);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.holding_item = false; }
};

}  // namespace

std::unique_ptr<Sensor> MakeGripperSensors(const Arena& /*arena*/, std::span<const RobotSensors> /*robots*/) {
  return std::make_unique<GripperSensor>();
}

}  // namespace gauntlet::sim
