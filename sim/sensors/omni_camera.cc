// The foot-bot's omnidirectional camera and the LEDs and lamps it sees (ARGoS
// colored_blob_omnidirectional_camera; measured in tests/golden/argos/sensors/cam_*.csv).

#include <algorithm>
#include <cmath>

#include "sim/sensors/seen_lists.h"
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kBlobsOfRobot = 1 + foot_bot::kRingLeds;
constexpr std::size_t kManyBlobs = 64 * kBlobsOfRobot;
constexpr double kHighestLight = 2.0 * foot_bot::kCameraHeight;

// Of a robot with heading 0, from its centre.
const std::array<Vec2, foot_bot::kRingLeds>& RestRing() {
  static const std::array<Vec2, foot_bot::kRingLeds> ring = [] {
    std::array<Vec2, foot_bot::kRingLeds> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = foot_bot::kRingRadius * UnitVector((static_cast<double>(i) + 0.5) * (kPi / 6.0));
    }
    return result;
  }();
  return ring;
}

double Side(const Vec2& offset) {
  return std::max(std::abs(offset.x()), std::abs(offset.y()));
}

bool HiddenByLowBox(const Scene& scene, const BodyFrame& viewer, const RobotPairs::Neighbour& other) {
  return scene.occluders.BoxBetween({viewer.position, foot_bot::kCameraHeight},
                                    {viewer.position + other.offset, foot_bot::kBeaconHeight});
}

// Allocates nothing unless a robot sees more than 64 robots.
class OmniCameras final : public Sensor {
 public:
  explicit OmniCameras(std::span<const RobotSensors> robots)
      : blobs_(robots.size(), robots.size() * std::min(kManyBlobs, (robots.size() + 1) * kBlobsOfRobot)) {
    for (const RobotSensors& robot : robots) ranges_.push_back(robot.CameraReach());
  }

  void Prepare(const Scene& scene) override;
  void Read(const Scene& /*scene*/, RobotIndex robot, SensorReadings& readings) override {
    readings.blobs = BlobsOf(robot);
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override { readings.blobs = {}; }
  void Disturb(const Scene& /*scene*/, RobotIndex robot, DeviceErrors& errors,
               SensorReadings& readings) override {
    readings.blobs = errors.Scatter(BlobsOf(robot), [](const Blob& blob) { return blob.range; });
  }

 private:
  std::span<Blob> BlobsOf(RobotIndex robot) { return blobs_.Of(static_cast<std::size_t>(robot)); }
  // Add blobs at `next`, which they move on.
  void AddRobots(const Scene& scene, std::span<const RobotPairs::Neighbour> others, RobotIndex viewer,
                 Blob*& next);
  void AddRing(const Scene& scene, RobotIndex viewer, RobotIndex other, Blob*& next);
  void AddLights(const Scene& scene, std::span<const Light> lights, RobotIndex viewer,
                 std::span<SightMemory> lines, Blob*& next);
  static void Add(const BodyFrame& viewer, const Vec2& offset, double range, Color color, Blob*& next) {
    next->position = viewer.FromWorld(offset);
    next->range = range;
    next->color = color;
    ++next;
  }

  std::vector<double> ranges_;  // half side (m) of the world-aligned square that a camera sees, 0 = no camera
  SeenLists<Blob> blobs_;
  SightMemories lines_;  // to the lights that surround the robots
  SightMemories lines_to_obstacles_;
};

void OmniCameras::Prepare(const Scene& scene) {
  blobs_.Clear();
  const std::span<const Light> lights = scene.surroundings.lights();
  lines_.SetPlaces(ranges_.size(), lights.size());
  lines_to_obstacles_.SetPlaces(ranges_.size(), scene.obstacle_lights.size());
  const bool anybody_lit =
      scene.any_ring_lit || std::ranges::any_of(scene.signals, [](const Signals& signals) {
        return signals.beacon != Color::kBlack;
      });
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    using Neighbours = std::span<const RobotPairs::Neighbour>;
    const Neighbours others =
        anybody_lit ? scene.pairs.NeighboursOf(static_cast<RobotIndex>(i)) : Neighbours();
    Blob* next = blobs_.Begin(i, others.size() * (scene.any_ring_lit ? kBlobsOfRobot : 1) + lights.size() +
                                     scene.obstacle_lights.size());
    if (ranges_[i] > 0.0) {
      AddRobots(scene, others, static_cast<RobotIndex>(i), next);
      if (!lights.empty()) AddLights(scene, lights, static_cast<RobotIndex>(i), lines_.Of(i), next);
      if (!scene.obstacle_lights.empty()) {
        AddLights(scene, scene.obstacle_lights, static_cast<RobotIndex>(i), lines_to_obstacles_.Of(i), next);
      }
    }
    blobs_.End(i, next);
  }
}

void OmniCameras::AddRobots(const Scene& scene, std::span<const RobotPairs::Neighbour> others,
                            RobotIndex viewer, Blob*& next) {
  const BodyFrame self = scene.robots[static_cast<std::size_t>(viewer)];
  const double range = ranges_[static_cast<std::size_t>(viewer)];
  const bool all_high = scene.occluders.all_high();
  Blob* blob = next;
  for (const RobotPairs::Neighbour& other : others) {
    const Color beacon = scene.signals[static_cast<std::size_t>(other.robot)].beacon;
    if (beacon != Color::kBlack && other.clear && Side(other.offset) < range &&
        (all_high || !HiddenByLowBox(scene, self, other))) {
      Add(self, other.offset, other.distance, beacon, blob);
    }
    if (scene.any_ring_lit) AddRing(scene, viewer, other.robot, blob);
  }
  next = blob;
}

void OmniCameras::AddRing(const Scene& scene, RobotIndex viewer, RobotIndex other, Blob*& next) {
  const BodyFrame& self = scene.robots[static_cast<std::size_t>(viewer)];
  const BodyFrame& carrier = scene.robots[static_cast<std::size_t>(other)];
  const Signals& signals = scene.signals[static_cast<std::size_t>(other)];
  const double range = ranges_[static_cast<std::size_t>(viewer)];
  const Point3 camera = {self.position, foot_bot::kCameraHeight};
  for (std::size_t led = 0; led < signals.ring.size(); ++led) {
    if (signals.ring[led] == Color::kBlack) continue;
    const Vec2 place = carrier.ToWorld(RestRing()[led]);
    const Vec2 offset = place - self.position;
    if (!(Side(offset) < range)) continue;
    const Point3 lamp = {place, foot_bot::kRingHeight};
    // Half of a ring is hidden by its own robot: that is the cheapest to ask.
    if (BodyBetween(std::span(&carrier, 1), camera, lamp, -1, -1)) continue;
    if (scene.occluders.BoxBetween(camera, lamp)) continue;
    if (BodyBetween(scene.robots, camera, lamp, viewer, other)) continue;
    Add(self, offset, std::sqrt(offset.squaredNorm()), signals.ring[led], next);
  }
}

void OmniCameras::AddLights(const Scene& scene, std::span<const Light> lights, RobotIndex viewer,
                            std::span<SightMemory> lines, Blob*& next) {
  const BodyFrame& self = scene.robots[static_cast<std::size_t>(viewer)];
  const Point3 camera = {self.position, foot_bot::kCameraHeight};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    if (light.color == Color::kBlack || light.height >= kHighestLight) continue;
    const Vec2 offset = light.position - self.position;
    if (!(Side(offset) < ranges_[static_cast<std::size_t>(viewer)])) continue;
    if (light.occludable) {
      const Point3 lamp = {light.position, light.height};
      if (scene.occluders.BoxBetween(camera, lamp, lines[i])) continue;
      if (BodyBetween(scene.robots, camera, lamp, viewer, -1)) continue;
    }
    Add(self, offset, std::sqrt(offset.squaredNorm()), light.color, next);
  }
}

}  // namespace

std::unique_ptr<Sensor> MakeOmniCameras(const Arena& /*arena*/, std::span<const RobotSensors> robots) {
  return std::make_unique<OmniCameras>(robots);
}

}  // namespace gauntlet::sim
