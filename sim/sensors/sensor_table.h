// The sensors that there are: how each is made, and its row. SensorSuite reads them in the order of the rows.
#pragma once

#include <memory>
#include <span>

#include "sim/robot/devices.h"
#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

// The sensor of a kind, of the robots of a swarm in that arena.
using MakeSensor = std::unique_ptr<Sensor>(const Arena& arena, std::span<const RobotSensors> robots);

// Cameras see a blob for every beacon, ring LED and lamp that is not black, strictly inside their square and
// not hidden: robots in robot order, of each the beacon, then its ring; then lights in their order, then
// those of obstacles. Robots are lower than the line to a beacon and hide none; a ring LED may be hidden by a
// robot, by its own too. A robot does not see its own LEDs. Lamps 0.577 m (twice the camera's height) or more
// above the floor are not seen.
MakeSensor MakeOmniCameras;
// Radios hear those that are strictly nearer than the sender's range when no box and, if bodies block, no
// third robot stands between: robots in robot order, then radio beacons in theirs.
MakeSensor MakeRadios;
MakeSensor MakeProximityRings;
MakeSensor MakeLightSensors;
MakeSensor MakeMotorGroundSensors;
MakeSensor MakeBaseGroundSensors;
MakeSensor MakeDistanceScanners;
MakeSensor MakeGripperSensors;
MakeSensor MakePositioningSensors;
MakeSensor MakeWheelEncoders;

struct SensorKind {
  Device device;
  MakeSensor* make;
};
inline constexpr SensorKind kSensorKinds[] = {
    {Device::kOmnidirectionalCamera, MakeOmniCameras}, {Device::kRangeAndBearing, MakeRadios},
    {Device::kProximity, MakeProximityRings},          {Device::kLight, MakeLightSensors},
    {Device::kMotorGround, MakeMotorGroundSensors},    {Device::kBaseGround, MakeBaseGroundSensors},
    {Device::kDistanceScanner, MakeDistanceScanners},  {Device::kGripper, MakeGripperSensors},
    {Device::kPositioning, MakePositioningSensors},    {Device::kWheelEncoders, MakeWheelEncoders},
};

}  // namespace gauntlet::sim
