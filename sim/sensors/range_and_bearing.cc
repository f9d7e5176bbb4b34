// Range-and-bearing (ARGoS range_and_bearing_medium_sensor; measured in tests/golden/argos/sensors/rab*.csv).

#include <algorithm>
#include <cmath>

#include "sim/sensors/seen_lists.h"
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyMessages = 64;
// Up to this many robots, what is known of bodies between them is kept.
constexpr std::size_t kFewSenders = 100;
constexpr double kWaysRounding = 1e-6;  // m, more than sums over a run's trajectory lose

Point3 AntennaAt(const Vec2& position) {
  return {position, foot_bot::kRangeAndBearingHeight};
}

// Allocates nothing unless a robot hears more than 64 robots.
class Radios final : public Sensor {
 public:
  explicit Radios(std::span<const RobotSensors> robots)
      : radios_(robots.begin(), robots.end()),
        messages_(robots.size(), robots.size() * std::min(robots.size() + 1, kManyMessages)) {
    for (const RobotSensors& robot : robots) reaches_.push_back(robot.RadioReach());
    if (robots.size() <= kFewSenders) lines_.resize(robots.size() * robots.size());
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
  std::span<Message> MessagesOf(RobotIndex robot) { return messages_.Of(static_cast<std::size_t>(robot)); }
  // Whether a third robot stands between.
  bool BodyHides(const Scene& scene, std::size_t listener, std::size_t sender);
  // Write from `next` on and return where they end.
  Message* HearRobots(const Scene& scene, std::size_t listener, Message* next);
  Message* HearBeacons(const Scene& scene, std::size_t listener, Message* next);

  std::vector<RobotSensors> radios_;
  std::vector<double> reaches_;  // m, how far each is heard, 0 = no radio
  SeenLists<Message> messages_;
  // What a robot knows of bodies on the line to another, until the swarm has driven so far.
  struct Line {
    double until = 0.0;  // m
    bool hidden = false;
  };
  std::vector<Line> lines_;  // [listener][sender]; none in large swarms
  SightMemories lines_to_beacons_;
};

void Radios::Prepare(const Scene& scene) {
  messages_.Clear();
  const std::size_t beacons = scene.surroundings.radio_beacons().size();
  lines_to_beacons_.SetPlaces(radios_.size(), beacons);
  for (std::size_t i = 0; i < radios_.size(); ++i) {
    const std::size_t robots = scene.pairs.NeighboursOf(static_cast<RobotIndex>(i)).size();
    Message* next = messages_.Begin(i, robots + beacons);
    if (reaches_[i] > 0.0) next = HearBeacons(scene, i, HearRobots(scene, i, next));
    messages_.End(i, next);
  }
}

Message* Radios::HearRobots(const Scene& scene, std::size_t listener, Message* next) {
  const BodyFrame& self = scene.robots[listener];
  const RobotIndex robot = static_cast<RobotIndex>(listener);
  const bool all_high = scene.occluders.all_high();
  const bool bodies_block = radios_[listener].bodies_block_radio;
  const double listens = radios_[listener].listening_range;
  for (const RobotPairs::Neighbour& other : scene.pairs.NeighboursOf(robot)) {
    const std::size_t sender = static_cast<std::size_t>(other.robot);
    if (!other.clear || !(other.distance < reaches_[sender]) || other.distance > listens) continue;
    const Signals& signals = scene.signals[sender];
    if (signals.silent) continue;
    if (!all_high &&
        scene.occluders.BoxBetween(AntennaAt(self.position), AntennaAt(scene.robots[sender].position))) {
      continue;
    }
    if (bodies_block && BodyHides(scene, listener, sender)) continue;
    next->position = self.FromWorld(other.offset);
    next->range = other.distance;
    next->payload = signals.message;
    ++next;
  }
  return next;
}

bool Radios::BodyHides(const Scene& scene, std::size_t listener, std::size_t sender) {
  const auto self = static_cast<RobotIndex>(listener);
  const auto other = static_cast<RobotIndex>(sender);
  const Vec2& from = scene.robots[listener].position;
  const Vec2& to = scene.robots[sender].position;
  if (!lines_.empty()) {
    Line& line = lines_[std::min(listener, sender) * radios_.size() + std::max(listener, sender)];
    const double driven = scene.pairs.driven();
    if (driven < line.until) return line.hidden;
    const double room = BodyRoom(scene.positions, from, to, self, other);
    line.hidden = room < 0.0;
    // The line moves as far as its ends at most, and a body may come as far towards it.
    line.until = driven + 0.5 * std::abs(room) - kWaysRounding;
    if (driven < line.until) return line.hidden;
  }
  return BodyBetween(scene.robots, AntennaAt(from), AntennaAt(to), self, other);
}

Message* Radios::HearBeacons(const Scene& scene, std::size_t listener, Message* next) {
  const BodyFrame& self = scene.robots[listener];
  const Point3 antenna = AntennaAt(self.position);
  const double listens = radios_[listener].listening_range;
  const std::span<const RadioBeacon> beacons = scene.surroundings.radio_beacons();
  const std::span<SightMemory> lines = lines_to_beacons_.Of(listener);
  for (std::size_t i = 0; i < beacons.size(); ++i) {
    const RadioBeacon& beacon = beacons[i];
    const Vec2 offset = beacon.position - self.position;
    const double squared = offset.squaredNorm();
    if (!(squared < beacon.range * beacon.range) || squared > listens * listens) continue;
    const Point3 source = AntennaAt(beacon.position);
    if (scene.occluders.BoxBetween(antenna, source, lines[i])) continue;
    if (radios_[listener].bodies_block_radio &&
        BodyBetween(scene.robots, antenna, source, static_cast<RobotIndex>(listener), -1)) {
      continue;
    }
    next->position = self.FromWorld(offset);
    next->range = std::sqrt(offset.squaredNorm());
    next->payload = beacon.payload;
    ++next;
  }
  return next;
}

}  // namespace

std::unique_ptr<Sensor> MakeRadios(const Arena& /*arena*/, std::span<const RobotSensors> robots) {
  return std::make_unique<Radios>(robots);
}

}  // namespace gauntlet::sim
