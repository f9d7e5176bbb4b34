// The foot-bot's omnidirectional camera and the beacons it sees (ARGoS
// colored_blob_omnidirectional_camera; measured in tests/golden/argos/sensors/cam_beacon_*.csv).
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/robot/controller.h"
#include "sim/sensors/body_frame.h"

namespace gauntlet::sim {

// The cameras of a whole swarm, because a line of sight serves both its ends.
class OmniCameras {
 public:
  // ranges[i] is the half side (m) of the world-aligned square that robot i's camera sees, 0 = no camera.
  OmniCameras(const Arena& arena, std::span<const double> ranges);

  // What every camera sees of the robots' beacons: a blob for each beacon that is not black, stands strictly
  // inside the square and is not hidden by an obstacle (they are 1 m high; robots are lower than the line to
  // a beacon and hide none). A robot does not see its own beacon. Allocates nothing.
  void Look(std::span<const BodyFrame> robots, std::span<const Color> beacons);

  // Of the last Look, in robot order. Valid until the next Look.
  std::span<const Blob> BlobsOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(blobs_).subspan(index * (ranges_.size() - 1), counts_[index]);
  }

 private:
  struct Occluder {
    OrientedBox box;
    Vec2 min;  // m, axis-aligned bounds
    Vec2 max;
  };

  void FindOccluders(std::span<const BodyFrame> robots);
  bool Hidden(const Vec2& a, const Vec2& b) const;
  void Add(std::size_t viewer, const BodyFrame& frame, double range, double world_bearing, Color color);

  std::vector<Occluder> obstacles_;
  std::vector<std::size_t> occluders_;  // indices of obstacles_ between some of the robots
  std::vector<double> ranges_;
  std::vector<Blob> blobs_;  // [robot][robots - 1]
  std::vector<std::size_t> counts_;
};

}  // namespace gauntlet::sim
