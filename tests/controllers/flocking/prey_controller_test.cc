#include "controllers/flocking/prey_controller.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "gtest/gtest.h"
#include "sim/arena/path_planner.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::Vec2;

constexpr PreySettings kSettings = {0.05, 1.5, 0.5, 0.10, 0.15};
const Vec2 kStart = {2.5, 2.5};
const Vec2 kGoal = {-2.5, -2.5};

sim::TestCase WallAcross() {
  sim::TestCase test_case;
  test_case.obstacles = {{0.0, 0.0, 4.0, 0.2, 135.0}};  // square to the diagonal, both ends open
  return test_case;
}

// Drives the prey along `path` without physics: speed and turn rate are reached at once.
std::vector<Vec2> Drive(const std::vector<Vec2>& path, sim::Tick ticks) {
  sim::Observer observer(1, ticks);
  const sim::Headquarters headquarters(observer);
  PreyController prey(headquarters, 0, path, kSettings);
  const sim::SensorReadings readings;
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  Vec2 position = path.front();
  double heading = 0.0;
  std::vector<Vec2> track;
  for (sim::Tick tick = 0; tick <= ticks; ++tick) {
    const sim::RobotState state{position.x(), position.y(), heading, 0.0};
    observer.Record({&state, 1});
    track.push_back(position);
    prey.Step({tick, readings, actuators, random});
    const double forward = (actuators.left_wheel + actuators.right_wheel) / 2.0;
    const double turn = (actuators.right_wheel - actuators.left_wheel) / sim::foot_bot::kWheelDistance;
    position += forward * sim::kTickSeconds * sim::UnitVector(heading);
    heading = sim::WrapAngle(heading + turn * sim::kTickSeconds);
  }
  return track;
}

double ClearanceOf(const std::vector<Vec2>& points, const sim::Arena& arena) {
  double least = std::numeric_limits<double>::max();
  for (const Vec2& point : points) {
    for (const sim::OrientedBox& box : arena.boxes()) least = std::min(least, sim::Distance(box, point));
  }
  return least;
}

TEST(PreyController, GoesStraightToTheGoalInAnEmptyArena) {
  const sim::Arena arena{sim::TestCase{}};
  const std::vector<Vec2> path = PlanPreyPath(arena, kStart, kGoal, kSettings.inflation);
  ASSERT_EQ(path.size(), 2u);
  const std::vector<Vec2> track = Drive(path, 2000);
  EXPECT_LT((track.back() - kGoal).norm(), 0.011);
  for (const Vec2& point : track) EXPECT_LT(std::abs(point.x() - point.y()), 0.02);
  // 7.07 m at 0.05 m/s after turning by 135 degrees at 1.5 rad/s.
  EXPECT_GT((track[1380] - kGoal).norm(), 0.15);
  EXPECT_LT((track[1420] - kGoal).norm(), 0.15);
}

TEST(PreyController, FollowsItsPathAroundAWall) {
  const sim::Arena arena(WallAcross());
  const std::vector<Vec2> path = PlanPreyPath(arena, kStart, kGoal, kSettings.inflation);
  ASSERT_GT(path.size(), 2u);
  EXPECT_GE(ClearanceOf(path, arena), 0.15 - sim::OccupancyGrid::kCellSize);
  const std::vector<Vec2> track = Drive(path, 3000);
  EXPECT_LT((track.back() - kGoal).norm(), 0.011);
  // Its body never touches anything.
  EXPECT_GT(ClearanceOf(track, arena), sim::foot_bot::kRadius);
}

TEST(PreyController, StaysAtTheEndOfItsPath) {
  const std::vector<Vec2> track = Drive({Vec2(0.0, 0.0), Vec2(1.0, 0.0)}, 600);
  EXPECT_EQ(track[400], track[600]);
}

TEST(PlanPreyPath, SqueezesThroughAGapThatOnlyTheBodyFits) {
  // A wall from side to side with a gap of 0.26 m: closed with 0.15 m on either side, open with 0.10 m.
  sim::TestCase test_case;
  test_case.obstacles = {{-1.63, 0.0, 3.0, 0.2, 0.0}, {1.63, 0.0, 3.0, 0.2, 0.0}};
  const sim::Arena arena(test_case);
  EXPECT_TRUE(sim::PlanPath(sim::OccupancyGrid(arena, 0.15), kStart, kGoal).empty());
  const std::vector<Vec2> path = PlanPreyPath(arena, kStart, kGoal, 0.15);
  ASSERT_FALSE(path.empty());
  EXPECT_GT(ClearanceOf(path, arena), sim::foot_bot::kRadius);
}

TEST(PlanPreyPath, IsEmptyWhenThereIsNoWay) {
  sim::TestCase test_case;
  test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  EXPECT_TRUE(PlanPreyPath(sim::Arena(test_case), kStart, kGoal, 0.15).empty());
}

}  // namespace
}  // namespace gauntlet::controllers
