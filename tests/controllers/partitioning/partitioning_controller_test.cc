// The state machine of thesis 6.2, transition by transition, with hand-made readings.
#include "controllers/partitioning/partitioning_controller.h"

#include "gtest/gtest.h"
#include "tests/controllers/partitioning/robot_fixture.h"

namespace gauntlet::controllers {
namespace {

using State = PartitioningState;
using Scene = PartitionScene;
using Robot = PartitionRobot;
using sim::kDegree;

constexpr double kSpeed = 0.05;

PartitionerSettings Static(const sim::Parameters& given = {}) {
  return PartitionerWith(StaticPartitionerParameters(), given);
}

// A robot that has just taken an item `distance` m from the nest.
Robot Carrier(double distance, const sim::Parameters& given = {}) {
  Robot robot(Static(given));
  EXPECT_EQ(robot.Step(Scene().Nest(distance).Carrying()), State::kGoToNest);
  return robot;
}

// A robot that has come 2 m and offers its item.
Robot Waiting(const sim::Parameters& given = {}) {
  Robot robot = Carrier(3.7, given);
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying()), State::kWaitForTransfer);
  return robot;
}

// A robot on its way back, its estimate 1 m behind it.
Robot Returning(const sim::Parameters& given = {}) {
  Robot robot = Carrier(3.7, given);
  EXPECT_EQ(robot.Step(Scene().Nest(2.7).Moved(1.0).Carrying()), State::kGoToNest);
  EXPECT_EQ(robot.Step(Scene().Nest(2.7)), State::kGoToSource);
  return robot;
}

// --- Explore ---

TEST(Explore, GoesStraightOnInTheOpen) {
  Robot robot(Static());
  EXPECT_EQ(robot.Step(Scene().Nest(3.0), 50), State::kExplore);
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
  EXPECT_NEAR(robot.turn(), 0.0, 1e-12);
}

TEST(Explore, BouncesFromWhatIsNearInFront) {
  Robot robot(Static());
  robot.Step(Scene().Nest(3.0).Hit(52.5, 0.051), 20);
  EXPECT_NEAR(robot.turn(), 0.0, 1e-12) << "not near enough";
  robot.Step(Scene().Nest(3.0).Hit(67.5, 0.01), 20);
  EXPECT_NEAR(robot.turn(), 0.0, 1e-12) << "aside";
  robot.Step(Scene().Nest(3.0).Hit(52.5, 0.049));
  EXPECT_GT(std::fabs(robot.turn()), 0.0);
  const double side = robot.turn();
  robot.Step(Scene().Nest(3.0).Hit(52.5, 0.049));
  EXPECT_GT(robot.turn() * side, 0.0) << "it does not change its mind while it turns";
}

TEST(Explore, ApproachesTheNearestItemAndStopsAtIt) {
  Robot robot(Static());
  EXPECT_EQ(robot.Step(Scene().Nest(3.0).Source(0.7, 90.0).Carrier(0.6, -90.0)), State::kExplore);
  EXPECT_LT(robot.turn(), 0.0);
  robot.Step(Scene().Nest(3.0).Source(0.5, 90.0).Carrier(0.6, -90.0));
  EXPECT_GT(robot.turn(), 0.0);
  robot.Step(Scene().Nest(3.0).Source(0.361));
  EXPECT_FALSE(robot.gripper_closed());
  robot.Step(Scene().Nest(3.0).Source(0.359));
  EXPECT_TRUE(robot.stands());
  EXPECT_TRUE(robot.gripper_closed());
}

TEST(Explore, DrivesStraightToAnItemThatIsNear) {
  Robot robot(Static());
  robot.Step(Scene().Nest(3.0).Source(0.44).Hit(7.5, 0.02).Hit(-7.5, 0.02));
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12) << "the field is off";
  robot.Step(Scene().Nest(3.0).Source(0.46, 1.0).Hit(7.5, 0.02).Hit(22.5, 0.02));
  EXPECT_LT(robot.turn(), 0.0) << "the field is on";
}

TEST(Explore, GoesToTheNestWithAnItemAndRemembersThePlace) {
  Robot robot(Static());
  EXPECT_EQ(robot.Step(Scene().Nest(3.7).Carrying()), State::kGoToNest);
  EXPECT_TRUE(robot.gripper_closed());
  EXPECT_EQ(robot.controller().estimate(), sim::Vec2(0.0, 0.0));
  robot.Step(Scene().Nest(3.6).Moved(0.1).Carrying());
  EXPECT_NEAR(robot.controller().estimate().x(), -0.1, 1e-12);
}

// --- Go to Nest ---

TEST(GoToNest, DrivesTowardsTheLight) {
  Robot robot = Carrier(3.7);
  robot.Step(Scene().Nest(3.0, 100.0).Carrying());
  EXPECT_GT(robot.turn(), 0.0);
  robot.Step(Scene().Nest(3.0, -170.0).Carrying());
  EXPECT_LT(robot.turn(), 0.0);
  robot.Step(Scene().Nest(3.0).Carrying());
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
}

TEST(GoToNest, TheFieldKeepsItOffObstacles) {
  Robot robot = Carrier(3.7);
  robot.Step(Scene().Nest(3.0).Hit(37.5, 0.02).Carrying());
  EXPECT_LT(robot.turn(), 0.0);
  robot.Step(Scene().Nest(3.0).Hit(-37.5, 0.02).Carrying());
  EXPECT_GT(robot.turn(), 0.0);
}

TEST(GoToNest, OpensTheGripperWhollyInsideTheNestAndThenGoesBack) {
  Robot robot = Carrier(3.7, {{"partition_length", 5.0}});
  EXPECT_EQ(robot.Step(Scene().Nest(0.5).HalfInNest().Carrying()), State::kGoToNest);
  EXPECT_TRUE(robot.gripper_closed());
  EXPECT_EQ(robot.Step(Scene().Nest(0.4).InNest().Carrying()), State::kGoToNest);
  EXPECT_FALSE(robot.gripper_closed());
  EXPECT_TRUE(robot.stands());
  EXPECT_EQ(robot.Step(Scene().Nest(0.4).InNest()), State::kGoToSource);
}

TEST(GoToNest, WaitsAfterThePartitionLength) {
  Robot robot = Carrier(3.7);
  EXPECT_EQ(robot.Step(Scene().Nest(1.71).Carrying()), State::kGoToNest);
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying()), State::kWaitForTransfer);
}

TEST(GoToNest, CarriesOnWhenItWouldWaitTooNearTheNest) {
  Robot near = Carrier(3.09);  // 3.09 - 2 < 1.1
  EXPECT_EQ(near.Step(Scene().Nest(1.0).Carrying()), State::kGoToNest);
  Robot far = Carrier(3.11);
  EXPECT_EQ(far.Step(Scene().Nest(1.1).Carrying()), State::kWaitForTransfer);
}

TEST(GoToNest, NeverWaitsWhenTheWaitingTimeIsZero) {
  Robot robot = Carrier(3.7, {{"wait_time", 0.0}});
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying()), State::kGoToNest);
  EXPECT_EQ(robot.Step(Scene().Nest(1.6).Carrying(), 100), State::kGoToNest);
}

// --- Wait for Transfer ---

TEST(WaitForTransfer, StandsWithAGreenBeacon) {
  Robot robot = Waiting();
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Hit(7.5, 0.01).Carrying(), 100), State::kWaitForTransfer);
  EXPECT_TRUE(robot.stands());
  EXPECT_TRUE(robot.gripper_closed());
  EXPECT_EQ(robot.beacon(), kCarrierColor);
  EXPECT_EQ(robot.says().step, HandoverStep::kOffer);
}

TEST(WaitForTransfer, GoesBackWhenTheItemIsTakenOver) {
  Robot robot = Waiting();
  EXPECT_EQ(robot.Step(Scene().Nest(1.69)), State::kGoToSource);
  EXPECT_EQ(robot.beacon(), sim::Color::kBlack);
}

TEST(WaitForTransfer, CarriesOnAfterItsTimeAndDoesNotWaitAgain) {
  Robot robot = Waiting();
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying(), 1800), State::kWaitForTransfer);
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying()), State::kGoToNest);
  EXPECT_EQ(robot.Step(Scene().Nest(1.0).Carrying(), 100), State::kGoToNest);
}

TEST(WaitForTransfer, AHandOverThatHasBegunIsFinishedFirst) {
  Robot robot = Waiting();
  robot.Step(Scene().Nest(1.69).Carrying(), 1799);
  const Scene asked = Scene().Nest(1.69).Carrying().Hear(0.24, HandoverStep::kRequest, 5, Robot::kNumber);
  EXPECT_EQ(robot.Step(asked, 160), State::kWaitForTransfer);
  EXPECT_EQ(robot.says().step, HandoverStep::kRelease);
  EXPECT_EQ(robot.beacon(), sim::Color::kBlack);
  EXPECT_EQ(robot.Step(Scene().Nest(1.69).Carrying(), 7), State::kGoToNest) << "the other has gone";
}

// --- Go to Source Position Estimate ---

TEST(GoToSource, DrivesToTheEstimate) {
  Robot robot = Returning();
  robot.Step(Scene().Nest(2.7));
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_GT(std::fabs(robot.turn()), 0.1) << "it lies behind";
  Scene turned = Scene().Nest(2.7);
  turned.motion.turn = sim::kPi;
  robot.Step(turned);
  EXPECT_NEAR(robot.controller().estimate().x(), 1.0, 1e-9);
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
}

TEST(GoToSource, SearchesTheNeighbourhoodOnceItIsThere) {
  Robot robot = Returning();
  EXPECT_EQ(robot.Step(Scene().Nest(2.7).Moved(-0.89)), State::kGoToSource);
  EXPECT_EQ(robot.Step(Scene().Nest(2.7).Moved(-0.02)), State::kNeighbourhood);
}

TEST(GoToSource, TakesAnItemOnTheWay) {
  EXPECT_EQ(Returning().Step(Scene().Nest(2.7).Carrying()), State::kGoToNest);
}

TEST(GoToSource, ExploresWhenItComesNoNearerForItsTime) {
  Robot robot = Returning();
  EXPECT_EQ(robot.Step(Scene().Nest(2.7), 298), State::kGoToSource);
  EXPECT_EQ(robot.Step(Scene().Nest(2.7).Moved(-0.02)), State::kGoToSource) << "some progress";
  EXPECT_EQ(robot.Step(Scene().Nest(2.7), 299), State::kGoToSource);
  EXPECT_EQ(robot.Step(Scene().Nest(2.7)), State::kExplore);
}

TEST(GoToSource, WithBugSItHasTimeForDetours) {
  EXPECT_EQ(PartitionerWith(BugPartitionerParameters()).no_progress, 1200);
  EXPECT_EQ(Static().no_progress, 300);
}

// --- Neighbourhood Exploration ---

TEST(Neighbourhood, IsWhereRobotsOfTheSteadyStateBegin) {
  Robot robot(Static(), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(2.0)), State::kNeighbourhood);
  EXPECT_EQ(robot.controller().estimate(), sim::Vec2(0.0, 0.0));
}

TEST(Neighbourhood, TurnsBackOutsideItsRadius) {
  Robot robot(Static(), State::kNeighbourhood);
  robot.Step(Scene().Nest(2.0).Moved(0.44));
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
  robot.Step(Scene().Nest(2.0).Moved(0.02));
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_GT(std::fabs(robot.turn()), 0.1);
}

TEST(Neighbourhood, TakesAnItem) {
  Robot robot(Static(), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(3.7).Carrying()), State::kGoToNest);
}

TEST(Neighbourhood, ExploresAfterItsTime) {
  Robot robot(Static(), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(2.0), 599), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(2.0)), State::kExplore);
}

TEST(Neighbourhood, ItsTimeStandsStillWhileItTakesAnItem) {
  Robot robot(Static(), State::kNeighbourhood);
  robot.Step(Scene().Nest(2.0), 590);
  EXPECT_EQ(robot.Step(Scene().Nest(2.0).Source(0.3), 100), State::kNeighbourhood);
}

// --- What it says ---

TEST(PartitioningController, TellsItsStateAndNumber) {
  Robot robot = Carrier(3.7);
  EXPECT_TRUE(robot.says().carrying);
  EXPECT_EQ(robot.says().state, State::kGoToNest);
  EXPECT_EQ(robot.says().self, Robot::kNumber);
  EXPECT_EQ(robot.says().partition_length, 2.0F);
}

// --- Dynamic ---

PartitionerSettings Dynamic(const sim::Parameters& given = {}) {
  return PartitionerWith(DynamicPartitionerParameters(), given);
}

TEST(Dynamic, LearnsFromWhatItFindsAndWhatItDoesNot) {
  Robot robot(Dynamic({{"start_partition_length", 1.0}}), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(3.7).Carrying()), State::kGoToNest);
  EXPECT_NEAR(robot.controller().partition_length(), 1.1, 1e-12);
  EXPECT_EQ(robot.Step(Scene().Nest(2.59).Carrying()), State::kWaitForTransfer) << "after 1.1 m";
  EXPECT_EQ(robot.Step(Scene().Nest(2.59)), State::kGoToSource);
  EXPECT_EQ(robot.Step(Scene().Nest(2.59)), State::kNeighbourhood);
  EXPECT_EQ(robot.Step(Scene().Nest(2.59), 600), State::kExplore);
  EXPECT_NEAR(robot.controller().partition_length(), 1.0, 1e-12);
  robot.Step(Scene().Nest(3.7).Carrying());
  EXPECT_NEAR(robot.controller().partition_length(), 1.0, 1e-12) << "found by exploring teaches nothing";
}

}  // namespace
}  // namespace gauntlet::controllers
