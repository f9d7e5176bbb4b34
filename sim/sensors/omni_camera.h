// The foot-bot's omnidirectional camera and the LEDs and lamps it sees (ARGoS
// colored_blob_omnidirectional_camera; measured in tests/golden/argos/sensors/cam_*.csv).
#pragma once

#include <span>
#include <vector>

#include "sim/robot/signals.h"
#include "sim/robot/surroundings.h"
#include "sim/sensors/body_frame.h"
#include "sim/sensors/occluders.h"
#include "sim/sensors/robot_pairs.h"

namespace gauntlet::sim {

// The cameras of a whole swarm.
class OmniCameras {
 public:
  // ranges[i] is the half side (m) of the world-aligned square that robot i's camera sees, 0 = no camera.
  explicit OmniCameras(std::span<const double> ranges);

  // What the tick offers to be seen.
  struct Scene {
    std::span<const BodyFrame> robots;
    const Occluders& occluders;
    const RobotPairs& pairs;
    std::span<const Signals> signals;
    bool any_ring_lit;
    std::span<const Light> lights;           // of the scenario
    std::span<const Light> obstacle_lights;  // of the obstacles
  };
  // What every camera sees: a blob for each beacon, ring LED and lamp that is not black, strictly inside the
  // square and not hidden. Robots are lower than the line to a beacon and hide none; a ring LED may be hidden
  // by a robot, by its own too. A robot does not see its own LEDs. Lamps 0.577 m (twice the camera's height)
  // or more above the floor are not seen. Allocates nothing unless a robot sees more than 64 robots.
  void Look(const Scene& scene);

  // Of the last Look: robots in robot order, of each the beacon, then its ring; then lights in their order,
  // then those of obstacles.
  std::span<const Blob> BlobsOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(blobs_).subspan(first_[index], first_[index + 1] - first_[index]);
  }

 private:
  void AddRing(const Scene& scene, RobotIndex viewer, RobotIndex other);
  void AddLights(const Scene& scene, std::span<const Light> lights, RobotIndex viewer);
  void Add(const BodyFrame& viewer, const Vec2& offset, double range, Color color);

  std::vector<double> ranges_;
  std::vector<Blob> blobs_;
  std::vector<std::size_t> first_;
};

}  // namespace gauntlet::sim
