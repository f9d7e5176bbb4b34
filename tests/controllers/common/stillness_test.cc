#include "controllers/common/stillness.h"

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(Stillness, IsKeepingWithinTheRadiusOfTheMeanPlace) {
  sim::Observer observer(1, 100);
  for (int tick = 0; tick <= 100; ++tick) {
    const sim::RobotState state{.x = tick < 20 ? 0.1 * tick : 2.0 + (tick % 2 == 0 ? 0.3 : -0.3)};
    observer.Record({&state, 1});
  }
  EXPECT_TRUE(KeptWithin(observer, 0, 70, 0.31));
  EXPECT_FALSE(KeptWithin(observer, 0, 70, 0.29));
  EXPECT_FALSE(KeptWithin(observer, 0, 100, 0.5));
  EXPECT_FALSE(KeptWithin(observer, 0, 101, 100.0)) << "longer than the run";
  EXPECT_EQ(StillSince(observer, 0, 70, 0.31), 17) << "it came from afar, and was there before the window";
}

}  // namespace
}  // namespace gauntlet::controllers
