#include "sim/physics/differential_drive.h"

#include <gtest/gtest.h>

namespace gauntlet::sim {
namespace {

Vec2 Displacement(const DriveMotion& motion) {
  return motion.halves[0] + motion.halves[1];
}

TEST(Drive, StartsWithTheForceOfTheMotor) {
  const DriveMotion motion = Drive({}, {0.10, 0.10}, {1.0, 0.0});
  EXPECT_NEAR(Displacement(motion).x(), 0.008892857, 1e-9);  // measured in ARGoS
  EXPECT_EQ(motion.end.velocity, Vec2(0.10, 0.0));
  EXPECT_EQ(motion.turn, 0.0);
}

TEST(Drive, KeepsASteadySpeed) {
  const DriveMotion motion = Drive({{0.0, 0.10}, 0.0}, {0.10, 0.10}, {0.0, 1.0});
  EXPECT_NEAR(motion.halves[0].y(), 0.005, 1e-15);
  EXPECT_NEAR(motion.halves[1].y(), 0.005, 1e-15);
}

TEST(Drive, TurnsOneSubstepLate) {
  const DriveMotion motion = Drive({}, {-0.10, 0.10}, {1.0, 0.0});
  EXPECT_NEAR(motion.turn, 0.128571428, 1e-8);  // measured in ARGoS
  EXPECT_NEAR(motion.end.turn_rate, 0.20 / 0.14, 1e-12);
  EXPECT_EQ(Displacement(motion), Vec2::Zero());
}

TEST(Drive, BrakesWithTheSameForce) {
  const DriveMotion motion = Drive({{0.30, 0.0}, 1.0}, {0.0, 0.0}, {1.0, 0.0});
  const double change = 15.0 * 0.01 / 1.68;
  EXPECT_NEAR(Displacement(motion).x(), 0.01 * (4 * 0.30 - 6 * change), 1e-12);
  EXPECT_EQ(motion.end.velocity, Vec2::Zero());
  EXPECT_NEAR(motion.turn, 0.01, 1e-15);
}

TEST(Drive, ChangesDirectionAlongTheStraightLineBetweenVelocities) {
  const DriveMotion motion = Drive({{0.30, 0.0}, 0.0}, {0.30, 0.30}, {0.0, 1.0});
  EXPECT_NEAR(motion.end.velocity.y(), 0.30, 1e-12);
  EXPECT_NEAR(Displacement(motion).x() / 0.01, 0.30 * 5 - 0.0892857143 / std::sqrt(2.0) * 10, 1e-6);
}

}  // namespace
}  // namespace gauntlet::sim
