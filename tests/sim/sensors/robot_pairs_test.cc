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
      if (i % 8 == 0) sensors.back().listening_range = 0.5;
    }
    const OrientedBox box = MakeBox({0.0, 0.0}, 2.0, 0.2, 0.5);
    RobotPairs pairs(sensors, {&box, 1});
    Occluders occluders;
    occluders.AddBox(box);
    std::vector<Vec2> places;
    std::vector<Signals> signals(robots);
    std::vector<bool> was_lit(robots, false);
    for (int round = 0; round < 30; ++round) {
      // Now and then all are elsewhere, then they drive on a little, and ever more show a light.
      const bool jump = round % 10 == 0;
      const double half_side = jump ? 4.0 / (1 + round / 10) : 0.05;
      if (jump) places.assign(robots, Vec2::Zero());
      for (std::size_t i = 0; i < robots; ++i) {
        const double x = random.Uniform(-half_side, half_side);
        places[i] += Vec2(x, random.Uniform(-half_side, half_side));
        if (i % 30 == static_cast<std::size_t>(round)) signals[i].beacon = Color::kRed;
        was_lit[i] = was_lit[i] || signals[i].beacon != Color::kBlack;
      }
      const bool ring_seen = round % 3 == 0;
      pairs.Update(places, signals, occluders, ring_seen);
      for (std::size_t i = 0; i < robots; ++i) {
        std::size_t next = 0;
        const auto found = pairs.NeighboursOf(static_cast<RobotIndex>(i));
        for (std::size_t j = 0; j < robots; ++j) {
          const Vec2 offset = places[j] - places[i];
          const double camera = std::max(was_lit[j] ? sensors[i].CameraReach() : 0.0,
                                         was_lit[i] ? sensors[j].CameraReach() : 0.0);
          const double radio = std::max(std::min(sensors[i].RadioReach(), sensors[j].EarReach()),
                                        std::min(sensors[j].RadioReach(), sensors[i].EarReach()));
          const bool clear = !occluders.BoxBetween({places[i], 0.1}, {places[j], 0.1});
          const bool counts = i != j && (clear || ring_seen) &&
                              (offset.cwiseAbs().maxCoeff() < camera || offset.norm() < radio);
          const bool listed = next < found.size() && found[next].robot == static_cast<RobotIndex>(j);
          EXPECT_TRUE(listed || !counts)
              << robots << " robots, round " << round << ": " << i << " misses " << j;
          if (!listed) continue;
          EXPECT_NE(i, j);
          const RobotPairs::Neighbour& other = found[next++];
          EXPECT_EQ(other.offset, offset);
          EXPECT_EQ(other.clear, clear);
          EXPECT_NEAR(other.distance, offset.norm(), 1e-12);
        }
        EXPECT_EQ(next, found.size()) << "of " << i;
      }
    }
  }
}

}  // namespace
}  // namespace gauntlet::sim
