#include "search/given/case_blame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace gauntlet {
namespace {

using testing::ElementsAre;

using Kept = std::vector<std::size_t>;
using Failures = std::function<int(const Kept&)>;  // of 30

bool Has(const Kept& kept, std::size_t obstacle) {
  return std::ranges::count(kept, obstacle) > 0;
}

// Which parts are to blame.
std::vector<Kept> Blamed(CaseBlame& blame, const Failures& failures) {
  while (blame.runs() > 0) {
    LayoutRuns told;
    told.tally.failures = failures(blame.layout().kept);
    told.tally.passes = blame.runs() - told.tally.failures;
    blame.Tell(told);
  }
  std::vector<Kept> blamed;
  for (const CaseBlame::Part& part : blame.parts()) {
    if (ClearlyLess(part.runs.tally, blame.parts().front().runs.tally)) blamed.push_back(part.without);
  }
  return blamed;
}

TEST(CaseBlameTest, NamesTheObstaclesWithoutWhichItDoesNotFail) {
  CaseBlame blame(sim::Genome(5), 30);
  EXPECT_THAT(Blamed(blame, [](const Kept& kept) { return Has(kept, 1) && Has(kept, 4) ? 29 : 5; }),
              ElementsAre(Kept{1}, Kept{4}));
  EXPECT_EQ(blame.parts().size(), 6U);  // and no pairs
}

// Either of two obstacles is enough to make it fail.
TEST(CaseBlameTest, LooksAtPairsWhenNoSingleOneExplainsIt) {
  CaseBlame blame(sim::Genome(4), 30);
  EXPECT_THAT(Blamed(blame, [](const Kept& kept) { return Has(kept, 0) || Has(kept, 3) ? 30 : 2; }),
              ElementsAre(Kept{0, 3}));
  EXPECT_EQ(blame.parts().size(), 1U + 4U + 6U);
}

TEST(CaseBlameTest, ACaseThatNeverFailsTakesNoMoreRuns) {
  CaseBlame blame(sim::Genome(4), 30);
  EXPECT_TRUE(Blamed(blame, [](const Kept&) { return 0; }).empty());
  EXPECT_EQ(blame.parts().size(), 1U);
}

TEST(CaseBlameTest, OfManyObstaclesThePairsOfThoseThatRobotsVisitedMostAreTried) {
  CaseBlame blame(sim::Genome(12), 30);
  while (blame.runs() > 0) {
    LayoutRuns told;
    told.tally.failures = 30;
    for (const std::size_t obstacle : blame.layout().kept) told.visits.push_back(obstacle);
    blame.Tell(told);
  }
  EXPECT_EQ(blame.parts().size(), 1U + 12U + 28U);
  EXPECT_THAT(blame.parts()[13].without, ElementsAre(4, 5));
}

TEST(ClearlyLessTest, IsMoreThanThreeStandardErrors) {
  const FailureTally whole{.failures = 30};
  EXPECT_FALSE(ClearlyLess({.passes = 15, .refused = 15}, whole)) << "half of its runs were left out";
  EXPECT_TRUE(ClearlyLess({.passes = 16, .refused = 14}, whole));
  EXPECT_FALSE(ClearlyLess({.failures = 23, .passes = 7}, whole));
  EXPECT_TRUE(ClearlyLess({.failures = 20, .passes = 10}, whole));
  EXPECT_FALSE(ClearlyLess({.failures = 30}, {.failures = 15, .passes = 15}));  // more often
  EXPECT_FALSE(ClearlyLess({}, whole));
}

}  // namespace
}  // namespace gauntlet
