#include "sim/sensors/ground_sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::sim {
namespace {

using testing::ElementsAre;

// Black in front of the line x = 1.
class TwoHalves final : public Surroundings {
 public:
  double FloorGrey(const Vec2& point) const override { return point.x() > 1.0 ? 0.0 : 1.0; }
};

TEST(GroundSensor, LooksAtTheFloorUnderEachPlace) {
  const TwoHalves floor;
  EXPECT_THAT(SenseGround(BodyFrame(Pose{{1.0, 0.0}, 0.0}), kMotorGroundPlaces, floor),
              ElementsAre(0.0, 1.0, 1.0, 0.0));
  EXPECT_THAT(SenseGround(BodyFrame(Pose{{1.0, 0.0}, kPi / 2}), kMotorGroundPlaces, floor),
              ElementsAre(1.0, 1.0, 0.0, 0.0));
  EXPECT_THAT(SenseGround(BodyFrame(Pose{{1.0 - 0.05, 0.0}, 0.0}), kBaseGroundPlaces, floor),
              ElementsAre(0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0));
}

}  // namespace
}  // namespace gauntlet::sim
