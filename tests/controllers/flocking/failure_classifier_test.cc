// Covers: controllers/flocking/swarm_links.cc
#include "controllers/flocking/failure_classifier.h"

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::RobotIndex;
using sim::RobotState;
using sim::Tick;
using sim::Vec2;
using ::testing::ElementsAre;

constexpr double kRange = 1.6373;
constexpr SplitRule kRule = {{kRange, 20}, 50, 5};

// A trajectory made by hand: robot and tick -> state.
using Motion = std::function<RobotState(RobotIndex, Tick)>;

sim::Observer Record(int robots, Tick last, const Motion& motion) {
  sim::Observer observer(robots, last);
  std::vector<RobotState> states(static_cast<std::size_t>(robots));
  for (Tick tick = 0; tick <= last; ++tick) {
    for (RobotIndex robot = 0; robot < robots; ++robot) {
      states[static_cast<std::size_t>(robot)] = motion(robot, tick);
    }
    observer.Record(states);
  }
  return observer;
}

// From `start` in direction `heading` at `speed`.
RobotState Straight(const Vec2& start, double heading, double speed, Tick tick) {
  const Vec2 position = start + speed * tick * sim::kTickSeconds * sim::UnitVector(heading);
  return {position.x(), position.y(), heading, speed};
}

const sim::Arena& EmptyArena() {
  static const sim::Arena arena{sim::TestCase{}};
  return arena;
}

SplitHistory Find(const sim::Observer& observer, RobotIndex prey, const sim::Arena& arena = EmptyArena()) {
  return FindSplits(observer, arena, prey, kRule);
}

// Two clusters that start just within sight of each other and drive apart: the prey (robot 10) with birds
// 0..4 to the right, birds 5..9 at an angle of `angle` to that. Gives the distance in 15 s.
struct Parting {
  double angle = 0.0;
  double swarm_speed = 0.1;
  double lost_speed = 0.1;
};

constexpr Tick kPartingTicks = 150;
constexpr RobotIndex kPrey = 10;

Vec2 PartingStart(RobotIndex robot) {
  const double spread = 0.004 * (robot % 5);
  if (robot == kPrey) return {-0.5, -0.8};
  return {-0.5 + spread, robot < 5 ? -0.8 : 0.8};
}

RobotState PartingState(const Parting& parting, RobotIndex robot, Tick tick) {
  const bool lost = robot >= 5 && robot != kPrey;
  return Straight(PartingStart(robot), lost ? parting.angle : 0.0,
                  lost ? parting.lost_speed : parting.swarm_speed, tick);
}

// The last tick at which a bird of the lost five is near enough to somebody of the others.
Tick LastSight(const sim::Observer& observer) {
  for (Tick tick = observer.last_tick(); tick > 0; --tick) {
    const auto states = observer.At(tick);
    for (std::size_t i = 5; i < 10; ++i) {
      for (const std::size_t j : {0u, 1u, 2u, 3u, 4u, 10u}) {
        if ((states[i].position() - states[j].position()).norm() <= kRange) return tick;
      }
    }
  }
  return 0;
}

class EveryFailureType : public ::testing::TestWithParam<int> {};

TEST_P(EveryFailureType, IsRecognised) {
  const int type = GetParam();
  const int bin = type % 10;
  for (const double offset : {0.5, 5.0, 9.5}) {
    for (const bool swarm_is_slower : {false, true}) {
      Parting parting;
      parting.angle = (bin == 9 ? 90.0 + 9.0 * offset : 10.0 * bin + offset) * kDegree;
      (swarm_is_slower ? parting.swarm_speed : parting.lost_speed) = type < 10 ? 0.06 : 0.04;
      const sim::Observer observer = Record(
          11, kPartingTicks, [&](RobotIndex robot, Tick tick) { return PartingState(parting, robot, tick); });
      const SplitHistory history = Find(observer, kPrey);
      ASSERT_EQ(history.events.size(), 1u) << parting.angle / kDegree;
      const SplitEvent& split = history.events.front();
      EXPECT_THAT(split.birds, ElementsAre(5, 6, 7, 8, 9));
      EXPECT_THAT(split.remaining, ElementsAre(0, 1, 2, 3, 4));
      EXPECT_EQ(split.tick, LastSight(observer));
      EXPECT_EQ(split.detected, split.tick + 20);
      const RelativeMotion motion = CompareMotion(observer, split, kRule.half_window);
      EXPECT_NEAR(motion.angle, parting.angle, 1e-12);
      EXPECT_NEAR(motion.speed_ratio, type < 10 ? 0.6 : 0.4, 1e-9);
      EXPECT_EQ(FailureTypeOf(motion), type);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, EveryFailureType, ::testing::Range(0, kFailureTypes));

TEST(FailureTypeOf, ClosesEachBinAtItsUpperEnd) {
  for (int bin = 0; bin < 9; ++bin) {
    const double upper = 10.0 * (bin + 1) * kDegree;
    EXPECT_EQ(FailureTypeOf({upper, 1.0}), bin);
    EXPECT_EQ(FailureTypeOf({upper + 1e-6, 1.0}), bin + 1);
  }
  EXPECT_EQ(FailureTypeOf({0.0, 1.0}), 0);
  EXPECT_EQ(FailureTypeOf({sim::kPi, 1.0}), 9);
}

TEST(FailureTypeOf, CountsExactlyHalfTheSpeedAsSimilar) {
  EXPECT_EQ(FailureTypeOf({0.0, 0.5}), 0);
  EXPECT_EQ(FailureTypeOf({0.0, 0.499999}), 10);
}

TEST(FailureLabel, SaysEachTypeInDifferentWords) {
  std::set<std::string> labels;
  for (int type = 0; type < kFailureTypes; ++type) labels.insert(FailureLabel(type));
  EXPECT_EQ(labels.size(), 20u);
  EXPECT_EQ(FailureLabel(0), "0-10 degrees apart, similar speeds");
  EXPECT_EQ(FailureLabel(12), "20-30 degrees apart, one cluster slower than half the other");
  EXPECT_EQ(FailureLabel(19), "over 90 degrees apart, one cluster slower than half the other");
}

TEST(FindSplits, FindsNoneInAFlockThatStaysTogether) {
  const sim::Observer observer = Record(11, 200, [](RobotIndex robot, Tick tick) {
    return Straight({-1.0 + 0.2 * robot, 0.1 * (robot % 3)}, 0.3, 0.05, tick);
  });
  const SplitHistory history = Find(observer, kPrey);
  EXPECT_TRUE(history.events.empty());
  EXPECT_EQ(LastSplit(history.events), nullptr);
  EXPECT_THAT(history.main_cluster, ::testing::Each(1));
}

TEST(FindSplits, FollowsAChainOfBirdsToTheLastOne) {
  // Neighbours are 0.5 m apart, the ends 4.5 m.
  const sim::Observer observer = Record(10, 60, [](RobotIndex robot, Tick tick) {
    return Straight({-2.4 + 0.5 * robot, 0.0}, 0.0, 0.01, tick);
  });
  EXPECT_TRUE(Find(observer, 9).events.empty());
}

// Bird 0 is away from the flock (birds 1, 2 and the prey 3) in the ticks of [from, to).
sim::Observer Excursion(Tick last, Tick from, Tick to) {
  return Record(4, last, [=](RobotIndex robot, Tick tick) {
    const bool away = robot == 0 && tick >= from && tick < to;
    return RobotState{away ? 2.5 : -0.5 + 0.2 * robot, 0.0, 0.0, 0.0};
  });
}

TEST(FindSplits, TheLinkOutlastsAnAbsenceShorterThanItsMemory) {
  EXPECT_TRUE(Find(Excursion(300, 100, 119), 3).events.empty());
}

TEST(FindSplits, ARobotThatRejoinsWithinFiveSecondsWasNeverLost) {
  // Last seen at tick 99, missed at 119, back at 165: 46 ticks later.
  const SplitHistory history = Find(Excursion(300, 100, 165), 3);
  EXPECT_TRUE(history.events.empty());
  EXPECT_THAT(history.main_cluster, ::testing::Each(1));
}

TEST(FindSplits, ARobotThatIsBackAfterMoreThanFiveSecondsHadSplitOff) {
  EXPECT_TRUE(Find(Excursion(300, 100, 169), 3).events.empty());
  const SplitHistory history = Find(Excursion(300, 100, 170), 3);
  ASSERT_EQ(history.events.size(), 1u);
  EXPECT_EQ(history.events[0].tick, 99);
  EXPECT_EQ(history.events[0].detected, 119);
  EXPECT_THAT(history.events[0].birds, ElementsAre(0));
  EXPECT_THAT(history.events[0].remaining, ElementsAre(1, 2));
  EXPECT_THAT(history.main_cluster, ::testing::Each(1));
}

TEST(FindSplits, ARobotStillAwayAtTheEndHadSplitOff) {
  EXPECT_TRUE(Find(Excursion(118, 100, 200), 3).events.empty());
  const SplitHistory history = Find(Excursion(119, 100, 200), 3);
  ASSERT_EQ(history.events.size(), 1u);
  EXPECT_THAT(history.main_cluster, ElementsAre(0, 1, 1, 1));
}

TEST(FindSplits, BirdsThatNeverJoinedSplitOffAtTheStart) {
  const sim::Observer observer = Record(5, 100, [](RobotIndex robot, Tick) {
    const double x[] = {-2.5, -2.3, 2.5, 2.3, 2.4};
    return RobotState{x[robot], 0.0, 0.0, 0.0};
  });
  const SplitHistory history = Find(observer, 4);
  ASSERT_EQ(history.events.size(), 1u);
  EXPECT_EQ(history.events[0].tick, 0);
  EXPECT_EQ(history.events[0].detected, 20);
  EXPECT_THAT(history.events[0].birds, ElementsAre(0, 1));
}

TEST(FindSplits, ComparesWithThePreyWhenNoBirdIsLeft) {
  const sim::Observer observer = Record(3, 150, [](RobotIndex robot, Tick tick) {
    return RobotState{robot < 2 && tick > 50 ? 2.5 : 0.0, 0.0, 0.0, 0.0};
  });
  const SplitHistory history = Find(observer, 2);
  ASSERT_EQ(history.events.size(), 1u);
  EXPECT_THAT(history.events[0].birds, ElementsAre(0, 1));
  EXPECT_THAT(history.events[0].remaining, ElementsAre(2));
}

TEST(FindSplits, AWallBetweenCutsTheLink) {
  sim::TestCase test_case;
  test_case.obstacles = {{0.0, 0.5, 2.0, 0.2, 90.0}};  // from (0, -0.5) to (0, 1.5)
  const sim::Arena arena(test_case);
  // Both drive up at +-0.3 m of the wall's line, from below its end to beside it.
  const sim::Observer observer = Record(2, 200, [](RobotIndex robot, Tick tick) {
    return Straight({robot == 0 ? -0.3 : 0.3, -1.0}, sim::kPi / 2.0, 0.1, tick);
  });
  EXPECT_TRUE(Find(observer, 1).events.empty());
  const SplitHistory history = Find(observer, 1, arena);
  ASSERT_EQ(history.events.size(), 1u);
  // y = -0.5 is reached at tick 50.
  EXPECT_NEAR(history.events[0].tick, 49, 1);
}

TEST(FindSplits, SeparateGroupsThatLeaveTogetherAreSeparateEvents) {
  // Birds 0, 1 to one side and bird 2 to the other; bird 3 stays with the prey 4.
  const sim::Observer observer = Record(5, 200, [](RobotIndex robot, Tick tick) {
    const double x[] = {-2.5, -2.4, 2.5, 0.1, 0.0};
    return RobotState{tick < 60 ? 0.0 : x[robot], 0.0, 0.0, 0.0};
  });
  const SplitHistory history = Find(observer, 4);
  ASSERT_EQ(history.events.size(), 2u);
  EXPECT_THAT(history.events[0].birds, ElementsAre(0, 1));
  EXPECT_THAT(history.events[1].birds, ElementsAre(2));
  // Same tick: the larger set counts.
  EXPECT_EQ(LastSplit(history.events), &history.events[0]);
}

TEST(LastSplit, OfTwoSplitsOnlyTheLastCounts) {
  // Birds 5..9 leave at 45 degrees and equal speed; later birds 3 and 4 leave backwards and slowly.
  const auto motion = [](RobotIndex robot, Tick tick) {
    if (robot >= 5 && robot != kPrey) return PartingState({45.0 * kDegree, 0.1, 0.1}, robot, tick);
    if (robot == 3 || robot == 4) {
      // Stand at x = 0.3 from tick 80 on, while the prey drives on.
      const Tick stop = 80;
      RobotState state = PartingState({}, robot, std::min(tick, stop));
      if (tick > stop) {
        state.heading = sim::kPi;
        state.x -= 0.02 * (tick - stop) * sim::kTickSeconds;
      }
      return state;
    }
    return PartingState({}, robot, tick);
  };
  const sim::Observer observer = Record(11, 330, motion);
  const SplitHistory history = Find(observer, kPrey);
  ASSERT_EQ(history.events.size(), 2u);
  EXPECT_THAT(history.events[0].birds, ElementsAre(5, 6, 7, 8, 9));
  EXPECT_EQ(FailureTypeOf(CompareMotion(observer, history.events[0], 5)), 4);
  const SplitEvent* last = LastSplit(history.events);
  ASSERT_NE(last, nullptr);
  EXPECT_THAT(last->birds, ElementsAre(3, 4));
  EXPECT_THAT(last->remaining, ElementsAre(0, 1, 2));
  EXPECT_EQ(FailureTypeOf(CompareMotion(observer, *last, 5)), 19);
}

TEST(LastSplit, PrefersTheLowestBirdAmongEquals) {
  SplitEvent high;
  high.tick = 50;
  high.birds = {4};
  SplitEvent low = high;
  low.birds = {2};
  const std::vector<SplitEvent> events = {high, low};
  EXPECT_EQ(LastSplit(events), &events[1]);
}

TEST(CompareMotion, CallsTwoStandingClustersEquallyFast) {
  const sim::Observer observer = Record(2, 60, [](RobotIndex robot, Tick tick) {
    return Straight({0.0, 0.0}, 0.0, robot == 0 ? 0.0009 : 0.0, tick);
  });
  SplitEvent split;
  split.tick = 30;
  split.birds = {0};
  split.remaining = {1};
  EXPECT_EQ(CompareMotion(observer, split, 5).speed_ratio, 1.0);
}

TEST(CompareMotion, CutsTheWindowAtTheEndsOfTheRun) {
  // Bird 0 stands for 3 ticks, then drives; at tick 0 the window is [0, 5].
  const sim::Observer observer = Record(2, 60, [](RobotIndex robot, Tick tick) {
    const Tick moving = robot == 0 ? std::max(0, tick - 3) : tick;
    return Straight({0.0, 0.0}, 0.0, 0.1, moving);
  });
  SplitEvent split;
  split.tick = 0;
  split.birds = {0};
  split.remaining = {1};
  EXPECT_NEAR(CompareMotion(observer, split, 5).speed_ratio, 0.4, 1e-12);
  split.tick = 60;
  EXPECT_NEAR(CompareMotion(observer, split, 5).speed_ratio, 1.0, 1e-12);
}

}  // namespace
}  // namespace gauntlet::controllers
