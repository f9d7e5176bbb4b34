#include "controllers/common/random_walk.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

sim::RandomStream Stream() {
  return {7, sim::StreamPurpose::kTest};
}

TEST(RandomWalk, GoesStraightOnWhileItDrawsNoNewHeading) {
  sim::RandomStream random = Stream();
  RandomWalk walk({0.0, 2.0});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(walk.Next(random), 0.0);
}

TEST(RandomWalk, RemembersWhatIsLeftToTurn) {
  sim::RandomStream random = Stream();
  RandomWalk walk({0.0, 2.0});
  walk.Turned(-0.5);  // half a radian too far to the right
  EXPECT_EQ(walk.Next(random), 0.5);
  walk.Turned(0.2);
  EXPECT_NEAR(walk.Next(random), 0.3, 1e-15);
  walk.Reset();
  EXPECT_EQ(walk.Next(random), 0.0);
}

TEST(RandomWalk, DrawsHeadingsAtItsRateWithinItsLimit) {
  sim::RandomStream random = Stream();
  RandomWalk walk({0.05, 2.0});
  int turns = 0;
  double least = 0.0;
  double most = 0.0;
  constexpr int kTicks = 100'000;
  for (int i = 0; i < kTicks; ++i) {
    const double bearing = walk.Next(random);
    if (bearing != 0.0) ++turns;
    least = std::min(least, bearing);
    most = std::max(most, bearing);
    walk.Reset();
  }
  // 5000 expected, standard deviation 69.
  EXPECT_NEAR(turns, 5000, 350);
  EXPECT_GE(least, -2.0);
  EXPECT_LT(least, -1.9);
  EXPECT_LE(most, 2.0);
  EXPECT_GT(most, 1.9);
}

}  // namespace
}  // namespace gauntlet::controllers
