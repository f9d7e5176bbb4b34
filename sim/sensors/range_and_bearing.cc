// Range-and-bearing (ARGoS range_and_bearing_medium_sensor; measured in tests/golden/argos/sensors/rab*.csv).

#include <algorithm>
#include <cmath>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyMessages = 64;

Point3 AntennaAt(const Vec2& position) {
  return {position, foot_bot::kRangeAndBearingHeight};
}

// Allocates nothing unless a robot hears more than 64 robots.
class Radios final : public Sensor {
 public:
  explicit Radios(std::span<const RobotSensors> robots)
      : radios_(robots.begin(), robots.end()), first_(robots.size() + 1) {
    messages_.reserve(robots.size() * std::min(robots.size() + 1, kManyMessages));
  }

  void Prepare(const Scene& scene) override;
  void Read(const Scene& /*scene*/, RobotIndex robot, SensorReadings& readings) override {
    readings.range_and_bearing = MessagesOf(robot);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.range_and_bearing = {}; }
  void Disturb(const Scene& /*scene*/, RobotIndex robot, DeviceErrors& errors,
               SensorReadings& readings) override {
    readings.range_and_bearing = errors.Scatter(MessagesOf(robot), [](const Message&) { return 1.0; });
  }

 private:
  std::span<Message> MessagesOf(RobotIndex robot) {
    const auto index = static_cast<std::size_t>(robot);
    return std::span(messages_).subspan(first_[index], first_[index + 1] - first_[index]);
  }
  void HearRobots(const Scene& scene, std::size_t listener);
  void HearBeacons(const Scene& scene, std::size_t listener);

  std::vector<RobotSensors> radios_;
  std::vector<Message> messages_;
  std::vector<std::size_t> first_;  // where the messages of a robot begin
};

void Radios::Prepare(const Scene& scene) {
  messages_.clear();
  for (std::size_t i = 0; i < radios_.size(); ++i) {
    first_[i] = messages_.size();
    if (radios_[i].RadioReach() <= 0.0) continue;
    HearRobots(scene, i);
    HearBeacons(scene, i);
  }
  first_.back() = messages_.size();
}

void Radios::HearRobots(const Scene& scene, std::size_t listener) {
  const BodyFrame& self = scene.robots[listener];
  const RobotIndex robot = static_cast<RobotIndex>(listener);
  for (const RobotPairs::Neighbour& other : scene.pairs.NeighboursOf(robot)) {
    const std::size_t sender = static_cast<std::size_t>(other.robot);
    if (!other.clear || !(other.distance < radios_[sender].RadioReach()) || scene.signals[sender].silent)
      continue;
    if (!scene.occluders.all_high() &&
        scene.occluders.BoxBetween(AntennaAt(self.position), AntennaAt(scene.robots[sender].position))) {
      continue;
    }
    if (radios_[listener].bodies_block_radio &&
        BodyBetween(scene.robots, AntennaAt(self.position), AntennaAt(scene.robots[sender].position), robot,
                    other.robot)) {
      continue;
    }
    messages_.push_back({.position = self.FromWorld(other.offset),
                         .range = other.distance,
                         .payload = scene.signals[sender].message});
  }
}

void Radios::HearBeacons(const Scene& scene, std::size_t listener) {
  const BodyFrame& self = scene.robots[listener];
  const Point3 antenna = AntennaAt(self.position);
  for (const RadioBeacon& beacon : scene.surroundings.radio_beacons()) {
    const Vec2 offset = beacon.position - self.position;
    if (!(offset.squaredNorm() < beacon.range * beacon.range)) continue;
    const Point3 source = AntennaAt(beacon.position);
    if (scene.occluders.BoxBetween(antenna, source)) continue;
    if (radios_[listener].bodies_block_radio &&
        BodyBetween(scene.robots, antenna, source, static_cast<RobotIndex>(listener), -1)) {
      continue;
    }
    messages_.push_back({.position = self.FromWorld(offset),
                         .range = std::sqrt(offset.squaredNorm()),
                         .payload = beacon.payload});
  }
}

}  // namespace

std::unique_ptr<Sensor> MakeRadios(const Arena& /*arena*/, std::span<const RobotSensors> robots) {
  return std::make_unique<Radios>(robots);
}

}  // namespace gauntlet::sim
