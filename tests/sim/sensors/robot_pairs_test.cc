#include "sim/sensors/robot_pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/random/random_stream.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

// Swarms of few robots and of many, against all pairs.
TEST(RobotPairs, FindEveryNeighbourInOrder) {
  for (const std::size_t robots : {1u, 2u, 20u, 41u, 150u}) {
    RandomStream random(robots, StreamPurpose::kTest);
    std::vector<RobotSensors> sensors;
    for (std::size_t i = 0; i < robots; ++i) {
      const DeviceSet camera = i % 3 == 0 ? DeviceSet() : Device::kOmnidirectionalCamera;
      const DeviceSet radio = i % 4 == 0 ? Device::kRangeAndBearing : DeviceSet();
      sensors.push_back({.devices = camera | radio, .camera_range = 0.8, .radio_range = 1.5});
    }
    const OrientedBox box = MakeBox({0.0, 0.0}, 2.0, 0.2, 0.5);
    RobotPairs pairs(sensors, {&box, 1});
    Occluders occluders;
    occluders.AddBox(box);
    for (int round = 0; round < 3; ++round) {
      std::vector<Vec2> places;
      const double half_side = 4.0 / (1 + round);
      for (std::size_t i = 0; i < robots; ++i) {
        const double x = random.Uniform(-half_side, half_side);
        const double y = random.Uniform(-half_side, half_side);
        places.emplace_back(x, y);
      }
      pairs.Update(places, occluders, false);
      for (std::size_t i = 0; i < robots; ++i) {
        std::size_t next = 0;
        const auto found = pairs.NeighboursOf(static_cast<RobotIndex>(i));
        for (std::size_t j = 0; j < robots; ++j) {
          const Vec2 offset = places[j] - places[i];
          const double camera = std::max(sensors[i].CameraReach(), sensors[j].CameraReach());
          const double radio = std::max(sensors[i].RadioReach(), sensors[j].RadioReach());
          if (i == j || (offset.cwiseAbs().maxCoeff() >= camera && offset.norm() >= radio)) continue;
          ASSERT_LT(next, found.size()) << robots << " robots, " << i << " misses " << j;
          const RobotPairs::Neighbour& other = found[next++];
          ASSERT_EQ(other.robot, static_cast<RobotIndex>(j)) << "of " << i;
          EXPECT_EQ(other.offset, offset);
          EXPECT_EQ(other.clear, !occluders.BoxBetween({places[i], 0.1}, {places[j], 0.1}));
          if (!other.clear) continue;
          EXPECT_NEAR(other.distance, offset.norm(), 1e-12);
        }
        EXPECT_EQ(next, found.size()) << "of " << i;
      }
    }
  }
}

}  // namespace
}  // namespace gauntlet::sim
