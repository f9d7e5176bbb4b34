#include "controllers/common/nest_and_food.h"

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(Stillness, IsKeepingWithinTheRadiusOfTheMeanPlace) {
  sim::Observer observer(1, 100);
  for (int tick = 0; tick <= 100; ++tick) {
    const sim::RobotState state{.x = tick < 20 ? 0.1 * tick : 2.0 + (tick % 2 == 0 ? 0.3 : -0.3)};
    observer.Record({&state, 1});
  }
  EXPECT_GT(StillSince(observer, 0, 70, 0.29), 30);
  EXPECT_GT(StillSince(observer, 0, 100, 0.5), 0);
  EXPECT_EQ(StillSince(observer, 0, 70, 0.31), 17) << "it came from afar, and was there before the window";
}

}  // namespace
}  // namespace gauntlet::controllers
