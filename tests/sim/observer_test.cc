#include "sim/observer.h"

#include <gtest/gtest.h>

#include <vector>

namespace gauntlet::sim {
namespace {

TEST(Observer, GivesBackWhatWasRecorded) {
  Observer observer(2, 10);
  EXPECT_EQ(observer.last_tick(), -1);
  for (int tick = 0; tick <= 10; ++tick) {
    observer.Record(std::vector<RobotState>{{.x = 1.0 * tick}, {.x = -1.0 * tick, .speed = 0.5}});
  }
  EXPECT_EQ(observer.last_tick(), 10);
  EXPECT_EQ(observer.At(3)[0].x, 3.0);
  EXPECT_EQ(observer.At(3)[1].x, -3.0);
  EXPECT_EQ(observer.Latest()[1].speed, 0.5);
}

TEST(Observer, KeepsItsMemoryWithinTheTickLimit) {
  Observer observer(1, 100);
  observer.Record(std::vector<RobotState>{{.x = 1.0}});
  const RobotState* first = observer.At(0).data();
  for (int tick = 1; tick <= 100; ++tick) observer.Record(std::vector<RobotState>(1));
  EXPECT_EQ(observer.At(0).data(), first);
}

TEST(ObserverDeathTest, RefusesAnotherNumberOfRobots) {
  Observer observer(2, 10);
  EXPECT_DEATH(observer.Record(std::vector<RobotState>(3)), "one state per robot");
}

}  // namespace
}  // namespace gauntlet::sim
