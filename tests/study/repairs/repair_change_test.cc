#include "study/repairs/repair_change.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/study/repairs/repaired_swarm.h"

namespace gauntlet {
namespace {

using testing_support::kHeldOut;
using testing_support::kTrainingCases;
using testing_support::RepairedSwarm;

constexpr std::size_t kFirst = 2 * kTrainingCases;

// What fails below a factor of .7; the first three held-out cases fail with every setting.
RepairChange Change(std::vector<std::size_t> units) {
  const Repair repair = RepairedSwarm([](double factor, double rate, std::size_t of_case) {
    return testing_support::FactorIsAtFault(factor, rate, of_case) ||
           (of_case >= kFirst && of_case < kFirst + 3);
  });
  return ChangeOf(repair.course(), kFirst, kHeldOut, std::move(units)).value();
}

TEST(RepairChange, UnitsCountByTheirCases) {
  const RepairChange by_case = Change({});
  const RepairChange by_unit = Change({3, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  for (const RepairChange& one : {by_case, by_unit}) {
    EXPECT_EQ(one.before, 1.0);
    EXPECT_EQ(one.after, 0.25);
    EXPECT_EQ(one.less, 0.75);
    EXPECT_LT(one.after_interval.low, 0.25);
    EXPECT_GT(one.after_interval.high, 0.25);
    EXPECT_LT(one.less_interval.low, 0.75);
    EXPECT_GT(one.less_interval.high, 0.75);
  }
  // Three of twelve, but one of ten that are independent.
  EXPECT_GT(by_unit.after_interval.high, by_case.after_interval.high);
  EXPECT_LT(by_unit.less_interval.low, by_case.less_interval.low);
}

TEST(RepairChange, IntervalsOfFewUnitsAreThoseOfTheirCases) {
  EXPECT_EQ(Change({6, 6}).after_interval.high, Change({}).after_interval.high);
}

TEST(RepairChange, HoldsTheIntervalOfAgrestiAndCoullWhereEachUnitIsACase) {
  const RepairChange change = Change(std::vector<std::size_t>(kHeldOut, 1));
  EXPECT_NEAR(change.after_interval.low, 0.08, 0.02);
  EXPECT_NEAR(change.after_interval.high, 0.54, 0.02);
}

}  // namespace
}  // namespace gauntlet
