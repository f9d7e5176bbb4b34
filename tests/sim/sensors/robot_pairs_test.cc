#include "sim/sensors/robot_pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/random/random_stream.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

// Swarms that are asked pair by pair and swarms that need the grid, against all pairs.
TEST(RobotPairs, FindEveryNeighbourInOrder) {
  for (const std::size_t robots : {1u, 2u, 20u, 41u, 150u}) {
    RandomStream random(robots, StreamPurpose::kTest);
    std::vector<RobotPairs::Reach> reaches;
    for (std::size_t i = 0; i < robots; ++i) {
      const double camera = i % 3 == 0 ? 0.0 : 0.8;
      reaches.push_back({.camera = camera, .radio = i % 4 == 0 ? 1.5 : 0.0});
    }
    RobotPairs pairs(reaches);
    Occluders occluders;
    occluders.AddBox(MakeBox({0.0, 0.0}, 2.0, 0.2, 0.5));
    for (int round = 0; round < 3; ++round) {
      std::vector<BodyFrame> frames;
      const double half_side = 4.0 / (1 + round);
      for (std::size_t i = 0; i < robots; ++i) {
        const double x = random.Uniform(-half_side, half_side);
        const double y = random.Uniform(-half_side, half_side);
        frames.emplace_back(Pose{{x, y}, 0.0});
      }
      occluders.Frame(frames);
      pairs.Update(frames, occluders, false);
      for (std::size_t i = 0; i < robots; ++i) {
        std::size_t next = 0;
        const auto found = pairs.NeighboursOf(static_cast<RobotIndex>(i));
        for (std::size_t j = 0; j < robots; ++j) {
          const Vec2 offset = frames[j].position - frames[i].position;
          const double camera = std::max(reaches[i].camera, reaches[j].camera);
          const double radio = std::max(reaches[i].radio, reaches[j].radio);
          if (i == j || (offset.cwiseAbs().maxCoeff() >= camera && offset.norm() >= radio)) continue;
          ASSERT_LT(next, found.size()) << robots << " robots, " << i << " misses " << j;
          const RobotPairs::Neighbour& other = found[next++];
          ASSERT_EQ(other.robot, static_cast<RobotIndex>(j)) << "of " << i;
          EXPECT_EQ(other.offset, offset);
          EXPECT_EQ(other.clear, !occluders.BoxBetween({frames[i].position, 0.1}, {frames[j].position, 0.1}));
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
