// The parts of the foraging scenario, each alone: messages, pheromone, the source of food, chains of beacons.
#include <cmath>
#include <limits>
#include <vector>

#include "controllers/common/food_source.h"
#include "controllers/foraging/beacon_chain.h"
#include "controllers/foraging/pheromone.h"
#include "controllers/foraging/radio_message.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(RadioMessage, SurvivesItsTenBytes) {
  for (int state = 0; state < kForagingStates; ++state) {
    const RadioMessage message{.sender = RadioMessage::Sender::kRobot,
                               .state = static_cast<ForagingState>(state),
                               .carrying = state % 2 == 1,
                               .first = 0.1F + static_cast<float>(state),
                               .second = std::numeric_limits<float>::infinity()};
    EXPECT_EQ(Decode(Encode(message)), message);
  }
  const RadioMessage nest{.sender = RadioMessage::Sender::kNest};
  EXPECT_EQ(Decode(Encode(nest)), nest);
}

TEST(RadioMessage, HasFixedBytes) {
  const sim::Payload payload = Encode({.sender = RadioMessage::Sender::kRobot,
                                       .state = ForagingState::kBeacon,
                                       .carrying = false,
                                       .first = 1.0F,
                                       .second = -2.0F});
  EXPECT_THAT(payload, ::testing::ElementsAre(7, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0));
}

TEST(RadioMessage, SilenceAndGarbageComeFromNobody) {
  EXPECT_EQ(Decode(sim::Payload{}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Decode(sim::Payload{8}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Decode(sim::Payload{200, 1, 2, 3}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Encode({}), sim::Payload{});
}

constexpr PheromoneSettings kPheromone = {.decay_time = 300.0, .trail_time = 60.0, .speed = 0.05};

TEST(Pheromone, EvaporatesByItsTimeConstant) {
  Pheromone level;
  level.Lay(LaidStaleness(30.0, 1.5, kPheromone));
  EXPECT_NEAR(std::exp(-level.staleness()), std::exp(-(30.0 + 1.5 / 0.05) / 60.0), 1e-12);
  for (int tick = 0; tick < 3000; ++tick) level.Evaporate(kPheromone);
  EXPECT_NEAR(std::exp(-level.staleness()), std::exp(-1.0) * std::exp(-1.0), 1e-12);
}

TEST(Pheromone, KeepsTheLargerLevel) {
  Pheromone level;
  EXPECT_EQ(level.staleness(), kNoPheromone);
  level.Evaporate(kPheromone);
  EXPECT_EQ(level.staleness(), kNoPheromone);
  level.Lay(2.0);
  level.Lay(3.0);
  EXPECT_EQ(level.staleness(), 2.0);
  level.Lay(1.0);
  EXPECT_EQ(level.staleness(), 1.0);
  level.Clear();
  EXPECT_EQ(level.staleness(), kNoPheromone);
}

TEST(Pheromone, BeaconsThatHearTheNestAreAboveOneTheNearestMost) {
  EXPECT_NEAR(std::exp(-NestStaleness(1.0, 3.0)), 1.02, 1e-12);
  EXPECT_LT(NestStaleness(0.5, 3.0), NestStaleness(0.6, 3.0));
  EXPECT_LT(NestStaleness(2.999, 3.0), LaidStaleness(0.0, 0.0, kPheromone));
}

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
  FoodSource source_ = FoodSource({.reach = 0.335, .pickup = 20, .interval = 100}, 3);
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

// --- Chains ---

constexpr double kRange = 3.0;
const ChainEnds kEnds = {{0.0, -2.0}, {0.0, 2.0}};

std::size_t ChainLength(const std::vector<sim::Vec2>& beacons, const sim::TestCase& test_case = {}) {
  return FindBeaconChain(sim::Arena(test_case), kEnds, beacons, kRange).size();
}

TEST(BeaconChain, OneBeaconInRangeOfBothEndsIsAPath) {
  EXPECT_EQ(ChainLength({}), 0u);
  EXPECT_EQ(ChainLength({{0.0, 0.0}}), 3u);
  EXPECT_EQ(ChainLength({{0.0, -1.5}}), 0u) << "3.5 m from the food";
  EXPECT_EQ(ChainLength({{0.0, 1.5}}), 0u) << "3.5 m from the nest";
  EXPECT_EQ(ChainLength({{0.0, -1.5}, {0.0, 1.4}}), 4u);
}

TEST(BeaconChain, GoesFromTheNestToTheFoodByTheFewestBeacons) {
  const auto chain = FindBeaconChain(sim::Arena(sim::TestCase{}), kEnds,
                                     std::vector<sim::Vec2>{{1.0, -1.8}, {0.5, 1.8}, {0.2, 0.1}}, kRange);
  ASSERT_EQ(chain.size(), 3u);
  EXPECT_EQ(chain[0], kEnds.nest);
  EXPECT_EQ(chain[1], sim::Vec2(0.2, 0.1));
  EXPECT_EQ(chain[2], kEnds.food);
}

TEST(BeaconChain, NeedsALineOfSight) {
  sim::TestCase wall;
  wall.obstacles = {{-0.5, 0.5, 4.0, 0.1, 0.0}};  // from x = -2.5 to 1.5
  EXPECT_EQ(ChainLength({{0.0, 0.0}}, wall), 0u);
  EXPECT_EQ(ChainLength({{0.0, 0.0}, {1.8, 0.3}}, wall), 3u) << "around the end";
}

}  // namespace
}  // namespace gauntlet::controllers
