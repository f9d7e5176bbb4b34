#include "search/given/case_minimiser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using Change = MinimisingStep::Change;

using Kept = std::vector<std::size_t>;

// The probability that a layout breaks the swarm.
using Truth = std::function<double(const Kept&)>;

bool Holds(const Kept& layout, std::size_t obstacle) {
  return std::ranges::count(layout, obstacle) > 0;
}

// Three walls, 1, 4 and 6, are a trap together.
double Trap(const Kept& layout) {
  return Holds(layout, 1) && Holds(layout, 4) && Holds(layout, 6) ? 1.0 : 0.0;
}

sim::Genome Boxes(std::size_t count) {
  sim::Genome genome;
  for (std::size_t i = 0; i < count; ++i)
    genome.push_back({.x = static_cast<double>(i), .length = 0.4, .width = 0.2});
  return genome;
}

constexpr MinimisingRules kRules = {.same_within = 1.0};

struct Minimised {
  MinimisedTo outcome = MinimisedTo::kOpen;
  Kept left;
  int runs = 0;
};

// `place`: where every failure happens.
Minimised Minimise(CaseMinimiser& minimiser, const Truth& truth, std::optional<sim::Vec2> place = {}) {
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  int runs = 0;
  while (minimiser.runs() > 0) {
    LayoutRuns told;
    for (int i = 0; i < minimiser.runs(); ++i, ++runs) {
      const bool failed = random.Chance(truth(minimiser.layout().kept));
      ++(failed ? told.tally.failures : told.tally.passes);
      if (failed && place) told.places.push_back(*place);
    }
    minimiser.Tell(told);
  }
  return {minimiser.outcome(), minimiser.layout().kept, runs};
}

TEST(CaseMinimiserTest, FindsATrapOfThreeWallsAmongFiveHarmlessBoxes) {
  CaseMinimiser minimiser(Boxes(8), kRules);
  const Minimised found = Minimise(minimiser, Trap);
  EXPECT_EQ(found.outcome, MinimisedTo::kLayout);
  EXPECT_THAT(found.left, ElementsAre(1, 4, 6));
  EXPECT_EQ(minimiser.verification().tally.runs(), 30);
}

TEST(CaseMinimiserTest, FindsItFromItsPlaceToo) {
  CaseMinimiser minimiser(Boxes(8), kRules);
  const Minimised found = Minimise(minimiser, Trap, sim::Vec2(4.0, 0.0));
  EXPECT_EQ(found.outcome, MinimisedTo::kLayout);
  EXPECT_THAT(found.left, ElementsAre(1, 4, 6));
}

TEST(CaseMinimiserTest, APlaceSavesRuns) {
  const Truth corner = [](const Kept& layout) { return Holds(layout, 7) ? 1.0 : 0.0; };
  CaseMinimiser with(Boxes(12), kRules);
  CaseMinimiser without(Boxes(12), kRules);
  const Minimised from_place = Minimise(with, corner, sim::Vec2(7.0, 0.0));
  const Minimised one_by_one = Minimise(without, corner);
  EXPECT_THAT(from_place.left, ElementsAre(7));
  EXPECT_THAT(one_by_one.left, ElementsAre(7));
  EXPECT_LT(from_place.runs, 60);
  EXPECT_LT(from_place.runs, one_by_one.runs);
}

TEST(CaseMinimiserTest, RefusesACaseThatDoesNotFail) {
  CaseMinimiser minimiser(Boxes(8), kRules);
  const Minimised found = Minimise(minimiser, [](const Kept&) { return 0.2; });
  EXPECT_EQ(found.outcome, MinimisedTo::kNoFailure);
  EXPECT_LE(found.runs, 10);
  EXPECT_EQ(minimiser.original().passes, 6);
}

TEST(CaseMinimiserTest, SaysThatTheEmptyArenaFailsToo) {
  CaseMinimiser minimiser(Boxes(8), kRules);
  const Minimised found = Minimise(minimiser, [](const Kept&) { return 1.0; });
  EXPECT_EQ(found.outcome, MinimisedTo::kEmpty);
  EXPECT_EQ(minimiser.empty().failures, 4);
  EXPECT_EQ(minimiser.original().failures, 5);
}

TEST(CaseMinimiserTest, KeepsAllObstaclesOfACaseThatNeedsThem) {
  CaseMinimiser minimiser(Boxes(5), kRules);
  const Minimised found =
      Minimise(minimiser, [](const Kept& layout) { return layout.size() == 5 ? 1.0 : 0.3; });
  EXPECT_EQ(found.outcome, MinimisedTo::kLayout);
  EXPECT_EQ(found.left.size(), 5U);
}

TEST(CaseMinimiserTest, ARunWithoutAResultEndsIt) {
  CaseMinimiser minimiser(Boxes(3), kRules);
  minimiser.Tell({.tally = {.failures = minimiser.runs() - 1, .errors = 1}, .places = {}, .visits = {}});
  EXPECT_EQ(minimiser.runs(), 0);
  EXPECT_EQ(minimiser.outcome(), MinimisedTo::kError);
}

TEST(CaseMinimiserTest, RunsThatAreLeftOutAreMadeUpFor) {
  CaseMinimiser minimiser(Boxes(2), kRules);
  // Of five runs one is refused, but that of obstacle 1 alone mostly.
  int asked = 0;
  const auto tell = [&] {
    const bool alone = minimiser.layout().kept == Kept{1};
    LayoutRuns told;
    for (int i = minimiser.runs(); i > 0; --i) {
      const bool refused = ++asked % 5 == 0 || (alone && asked % 3 != 0);
      const bool fails = Holds(minimiser.layout().kept, 1);
      ++(refused ? told.tally.refused : fails ? told.tally.failures : told.tally.passes);
    }
    minimiser.Tell(told);
  };
  while (minimiser.runs() > 0 && asked < 2000) tell();
  EXPECT_EQ(minimiser.outcome(), MinimisedTo::kLayout);
  EXPECT_EQ(minimiser.verification().tally.runs(), 30);
  EXPECT_EQ(minimiser.layout().kept, (Kept{0, 1})) << "what is mostly refused does not count as failing";
}

TEST(CaseMinimiserTest, ACaseThatIsMostlyRefusedIsNone) {
  CaseMinimiser minimiser(Boxes(2), kRules);
  while (minimiser.runs() > 0) minimiser.Tell({.tally = {.refused = minimiser.runs()}});
  EXPECT_EQ(minimiser.outcome(), MinimisedTo::kError);
}

// Obstacle 0 alone is lucky in the tests that choose it and not afterwards.
TEST(CaseMinimiserTest, TakesBackWhatWasLuckAndGoesOnWithOneObstacleMore) {
  CaseMinimiser minimiser(Boxes(4), kRules);
  bool seen = false;
  int of_one = 0;  // runs of obstacle 0 alone
  while (minimiser.runs() > 0) {
    const Kept& layout = minimiser.layout().kept;
    const bool lucky = layout == Kept{0} && of_one < 10;
    const bool fails = lucky || (Holds(layout, 0) && Holds(layout, 1));
    if (layout == Kept{0}) of_one += minimiser.runs();
    seen = seen || (layout == Kept{0} && !lucky);
    LayoutRuns told;
    (fails ? told.tally.failures : told.tally.passes) = minimiser.runs();
    if (fails) told.places.assign(static_cast<std::size_t>(minimiser.runs()), sim::Vec2(0.0, 0.0));
    minimiser.Tell(told);
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(minimiser.outcome(), MinimisedTo::kLayout);
  EXPECT_THAT(minimiser.layout().kept, ElementsAre(0, 1));
  ASSERT_EQ(minimiser.steps().size(), 2U);  // what was taken back is not told
  EXPECT_EQ(minimiser.steps()[0].layout.kept.size(), 4U);
  EXPECT_EQ(minimiser.steps()[1].change, Change::kNearest);
}

// Obstacle 0 fails alone, but elsewhere than the case as it is, where obstacle 5 makes it fail.
TEST(CaseMinimiserTest, AFailureElsewhereIsNotTheSameOne) {
  CaseMinimiser minimiser(Boxes(6), kRules);
  while (minimiser.runs() > 0) {
    const Kept& layout = minimiser.layout().kept;
    LayoutRuns told;
    (layout.empty() ? told.tally.passes : told.tally.failures) = minimiser.runs();
    // All together fail between both, so that the nearest is obstacle 2.
    const double place = layout.size() == 6 ? 2.0 : Holds(layout, 5) ? 2.5 : 9.0;
    if (told.tally.failures > 0) told.places.assign(static_cast<std::size_t>(minimiser.runs()), {place, 0.0});
    minimiser.Tell(told);
  }
  EXPECT_EQ(minimiser.outcome(), MinimisedTo::kLayout);
  EXPECT_TRUE(Holds(minimiser.layout().kept, 5));
  EXPECT_TRUE(minimiser.SameFailures(minimiser.verification()));
}

TEST(CaseMinimiserTest, TakesAwayFirstWhatRobotsVisitedLeast) {
  CaseMinimiser minimiser(Boxes(4), {});
  Kept taken_away_first;
  while (minimiser.runs() > 0) {
    const Kept& layout = minimiser.layout().kept;
    if (layout.size() == 3 && taken_away_first.empty()) taken_away_first = layout;
    LayoutRuns told;
    (Holds(layout, 2) ? told.tally.failures : told.tally.passes) = minimiser.runs();
    if (layout.size() == 4) told.visits = {5, 0, 7, 3};
    minimiser.Tell(told);
  }
  EXPECT_THAT(taken_away_first, ElementsAre(0, 2, 3));
  EXPECT_THAT(minimiser.layout().kept, ElementsAre(2));
  ASSERT_EQ(minimiser.steps().size(), 4U);
  EXPECT_EQ(minimiser.steps()[1].change, Change::kWithout);
  EXPECT_EQ(minimiser.steps()[1].obstacle, 1U);
}

// Obstacle 0 is needed, and more than half a metre of it.
TEST(CaseMinimiserTest, ShortensWhatIsLeftWhenAskedTo) {
  sim::Genome obstacles = Boxes(3);
  obstacles[0].length = 1.13;
  CaseMinimiser minimiser(obstacles, {.shorten = true});
  while (minimiser.runs() > 0) {
    const Layout& layout = minimiser.layout();
    const bool fails = Holds(layout.kept, 0) && layout.obstacles[0].length > 0.5;
    LayoutRuns told;
    (fails ? told.tally.failures : told.tally.passes) = minimiser.runs();
    minimiser.Tell(told);
  }
  EXPECT_THAT(minimiser.layout().kept, ElementsAre(0));
  EXPECT_EQ(minimiser.layout().obstacles[0].length, 0.6);
  EXPECT_EQ(minimiser.steps().back().change, Change::kShortened);
  EXPECT_EQ(minimiser.steps().back().length, 0.6);
  EXPECT_EQ(minimiser.verification().tally.failures, 30);
}

// A case that fails in six of ten runs has no part that fails in nearly all: it stays, and its figure is
// told.
TEST(CaseMinimiserTest, ACaseThatFailsNowAndThenStaysAsItIs) {
  CaseMinimiser minimiser(Boxes(4), kRules);
  const Minimised found =
      Minimise(minimiser, [](const Kept& layout) { return layout.size() == 4 ? 0.6 : 0.3; });
  EXPECT_EQ(found.outcome, MinimisedTo::kLayout);
  EXPECT_EQ(found.left.size(), 4U);
  EXPECT_EQ(minimiser.verification().tally.runs(), 30);
}

// Two outcomes of any kind and any luck: it ends, and what it names failed when it was verified.
TEST(CaseMinimiserTest, EndsWhateverItIsTold) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    sim::RandomStream random(seed, sim::StreamPurpose::kTest);
    CaseMinimiser minimiser(Boxes(seed % 9),
                            {.same_within = seed % 2 == 0 ? 1.0 : 0.0, .shorten = seed % 3 == 0});
    const double chance = 0.5 + 0.5 * random.Uniform();
    int runs = 0;
    while (minimiser.runs() > 0 && runs < 5000) {
      LayoutRuns told;
      for (int i = 0; i < minimiser.runs(); ++i, ++runs) {
        const bool failed = random.Chance(minimiser.layout().kept.empty() ? 0.1 : chance);
        ++(failed ? told.tally.failures : told.tally.passes);
        if (failed) told.places.emplace_back(8.0 * random.Uniform(), 0.0);
      }
      minimiser.Tell(told);
    }
    ASSERT_LT(runs, 5000) << seed;
    if (minimiser.outcome() != MinimisedTo::kLayout) continue;
    EXPECT_EQ(minimiser.verification().tally.runs(), 30) << seed;
    EXPECT_EQ(minimiser.layout(), minimiser.steps().back().layout) << seed;
    EXPECT_TRUE(minimiser.steps().size() == 1 || minimiser.verification().tally.failures >= 24) << seed;
  }
}

}  // namespace
}  // namespace gauntlet
