// Covers: controllers/common/nest_and_food.cc
#include "controllers/common/nest_and_food.h"

#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

// A source at the origin that serves every 100 ticks, after 20 ticks of standing.
class FoodSourceTest : public ::testing::Test {
 protected:
  FoodSourceTest() { Place({0.3, 0.3, 0.3}); }
  void Place(const std::vector<double>& distances) {
    for (std::size_t i = 0; i < distances.size(); ++i) robots_[i] = {.x = distances[i]};
  }
  // The robots served from now on for `ticks` ticks, with the tick.
  std::vector<std::pair<sim::Tick, sim::RobotIndex>> Run(int ticks) {
    std::vector<std::pair<sim::Tick, sim::RobotIndex>> served;
    for (int i = 0; i < ticks; ++i, ++tick_) {
      if (const auto robot = source_.Serve(tick_, robots_, grippers_)) served.emplace_back(tick_, *robot);
    }
    return served;
  }

  std::vector<sim::RobotState> robots_ = std::vector<sim::RobotState>(3);
  sim::Grippers grippers_ = sim::Grippers({true, true, true});
  FoodSource source_ =
      FoodSource({.robots = 3, .pickup_distance = 0.335, .pickup = 20, .serving_interval = 100});
  sim::Tick tick_ = 1;
};

TEST_F(FoodSourceTest, ServesClosedGrippersInReachInTheOrderOfArrival) {
  grippers_.SetClosed(2, true);
  EXPECT_TRUE(Run(5).empty());
  grippers_.SetClosed(0, true);
  grippers_.SetClosed(1, true);
  using Served = std::vector<std::pair<sim::Tick, sim::RobotIndex>>;
  EXPECT_EQ(Run(400), (Served{{21, 2}, {121, 0}, {221, 1}}));
  EXPECT_TRUE(grippers_.Holds(0) && grippers_.Holds(1) && grippers_.Holds(2));
}

TEST_F(FoodSourceTest, OneWhoLeavesLosesItsPlace) {
  grippers_.SetClosed(0, true);
  Run(10);
  grippers_.SetClosed(1, true);
  Run(1);
  Place({0.4, 0.3, 0.3});
  Run(1);
  EXPECT_FALSE(source_.Waits(0));
  EXPECT_TRUE(source_.Waits(1));
  Place({0.3, 0.3, 0.3});
  const auto served = Run(200);
  ASSERT_EQ(served.size(), 2u);
  EXPECT_EQ(served[0].second, 1);
  EXPECT_EQ(served[1].second, 0);
}

TEST_F(FoodSourceTest, ServesNobodyOutOfReachWithOpenGripperOrWithAnItem) {
  Place({0.336, 0.3, 0.3});
  grippers_.SetClosed(0, true);
  grippers_.SetClosed(2, true);
  grippers_.Give(2);
  EXPECT_TRUE(Run(300).empty());
}

TEST_F(FoodSourceTest, NeverRunsOut) {
  grippers_.SetClosed(0, true);
  int items = 0;
  for (int i = 0; i < 50; ++i) {
    items += static_cast<int>(Run(120).size());
    if (grippers_.Holds(0)) grippers_.Take(0);
  }
  EXPECT_GE(items, 45);
}

}  // namespace
}  // namespace gauntlet::controllers
