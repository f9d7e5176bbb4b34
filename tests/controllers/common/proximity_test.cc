#include "controllers/common/proximity.h"

#include <cmath>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(ProximityDirections, StartJustLeftOfTheHeadingAndGoCounterClockwise) {
  const auto& directions = ProximityDirections();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double bearing = (7.5 + 15.0 * static_cast<double>(i)) * sim::kDegree;
    EXPECT_NEAR(directions[i].x(), std::cos(bearing), 1e-13);
    EXPECT_NEAR(directions[i].y(), std::sin(bearing), 1e-13);
  }
}

TEST(ProximityReadingAt, FollowsTheSensorOfArgos) {
  EXPECT_EQ(ProximityReadingAt(0.005), 1.0);
  EXPECT_NEAR(ProximityReadingAt(0.009889556), 1.0, 1e-6);
  EXPECT_NEAR(ProximityReadingAt(0.05), 0.2004, 1e-4);
  EXPECT_NEAR(ProximityReadingAt(0.1), 0.1004, 1e-4);
}

TEST(Proximity, BodiesAreLeftOutOfTheReadings) {
  ProximityReadings readings{};
  readings.fill(ProximityReadingAt(0.05));
  const std::vector<SeenBody> bodies = {{0.22, 0.0}, {0.22, sim::kPi / 2.0}, {0.5, sim::kPi}};
  const ProximityReadings left = WithoutBodies(readings, bodies);
  EXPECT_EQ(left[0], 0.0);
  EXPECT_EQ(left[23], 0.0);
  EXPECT_EQ(left[6], 0.0);
  EXPECT_NE(left[12], 0.0) << "too far to be what was hit";
  EXPECT_NE(left[3], 0.0);
}

}  // namespace
}  // namespace gauntlet::controllers
