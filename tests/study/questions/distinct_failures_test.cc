#include "study/questions/distinct_failures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

// So many failed runs stood still, so many got lost, all at one place.
Confirmation Failed(RunId run, int stood, int lost, const std::string& place, int passes = 0) {
  Confirmation one{.run = run, .tally = {.failures = stood + lost, .passes = passes}};
  one.interval = FailureInterval(one.tally);
  one.verdict = VerdictOf(one.tally, one.tally.runs());
  for (int i = 0; i < stood + lost; ++i)
    one.failed.push_back({static_cast<RunId>(i + 1), {i < stood ? "stood" : "lost", place}});
  return one;
}

TEST(DistinctFailures, AreCasesMostOfWhoseRunsFailAlikeToughestFirst) {
  const std::vector<Confirmation> known = {Failed(1, 1, 11, "here", 8), Failed(2, 20, 0, "here"),
                                           Failed(3, 1, 19, "there"), Failed(4, 0, 14, "here", 6),
                                           Confirmation{}};
  SmallestLayout large, small;
  large.run = 4;
  large.document.test_case.obstacles.resize(4);
  small.run = 1;
  small.document.test_case.obstacles.resize(2);
  const std::vector<SmallestLayout> layouts = {large, small};
  const DistinctFailures distinct = DistinctFailuresOf(known, layouts);
  EXPECT_EQ(distinct.failing, 4);
  EXPECT_EQ(distinct.too_few, 0);
  const FailureGrouping& by_mechanism = distinct.groupings[0];
  ASSERT_THAT(by_mechanism.groups, SizeIs(2));
  const DistinctFailure& lost = by_mechanism.groups[0];
  EXPECT_EQ(lost.name, "lost");
  EXPECT_THAT(lost.cases, ElementsAre(&known[2], &known[3], &known[0]));
  EXPECT_DOUBLE_EQ(lost.share, 0.75);
  EXPECT_EQ(lost.agreeing_runs, 44);
  EXPECT_EQ(lost.failed_runs, 46);
  EXPECT_EQ(lost.typical->id, 2U) << "of run 3 the first did otherwise";
  EXPECT_EQ(lost.smallest, &layouts[1]);
  EXPECT_EQ(by_mechanism.groups[1].smallest, nullptr);
  EXPECT_THAT(distinct.groupings[1].groups, SizeIs(2));
  EXPECT_THAT(distinct.All(), SizeIs(4));
}

TEST(DistinctFailures, WhatIsMixedOrHasTooFewRunsIsNotCounted) {
  const std::vector<Confirmation> known = {Failed(1, 10, 0, ""), Failed(2, 0, 10, ""), Failed(3, 5, 5, ""),
                                           Failed(4, 9, 0, "")};
  const DistinctFailures distinct = DistinctFailuresOf(known, {});
  EXPECT_EQ(distinct.too_few, 1);
  EXPECT_EQ(distinct.groupings[0].mixed, 1);
  ASSERT_THAT(distinct.groupings[0].groups, SizeIs(2));
  EXPECT_DOUBLE_EQ(distinct.groupings[0].groups[0].share, 1.0 / 3.0);
  EXPECT_FALSE(distinct.groupings[1].Used()) << "no run has a place";
}

TEST(DistinctFailures, OneCaseIsOfWhatLeadsInIt) {
  const std::vector<Confirmation> known = {Failed(1, 18, 1, "here")};
  const DistinctFailures distinct = DistinctFailuresOf(known, {});
  EXPECT_EQ(distinct.groupings[0].agreement, std::nullopt);
  ASSERT_THAT(distinct.groupings[0].groups, SizeIs(1));
  EXPECT_EQ(distinct.groupings[0].groups[0].name, "stood");
}

TEST(DistinctFailures, AFeatureInWhichRunsOfACaseDoNotAgreeNamesNone) {
  const std::vector<Confirmation> known = {Failed(1, 6, 4, "here"), Failed(2, 4, 6, "there"),
                                           Failed(3, 10, 0, "here")};
  const DistinctFailures distinct = DistinctFailuresOf(known, {});
  EXPECT_FALSE(distinct.groupings[0].Used());
  EXPECT_THAT(distinct.groupings[0].groups, SizeIs(0));
  EXPECT_THAT(distinct.groupings[1].groups, SizeIs(2));
}

// Adding cases moves none from its group.
TEST(DistinctFailures, OtherCasesDoNotMoveACase) {
  std::vector<Confirmation> known = {Failed(1, 12, 1, "here"), Failed(2, 0, 15, "there")};
  const auto group_of_first = [&] {
    const DistinctFailures distinct = DistinctFailuresOf(known, {});
    for (const DistinctFailure& one : distinct.groupings[0].groups) {
      if (std::ranges::count(one.cases, RunId{1}, &Confirmation::run) > 0) return one.name;
    }
    return std::string();
  };
  EXPECT_EQ(group_of_first(), "stood");
  for (RunId run = 3; run < 20; ++run) known.push_back(Failed(run, 0, 15, "between"));
  EXPECT_EQ(group_of_first(), "stood");
}

}  // namespace
}  // namespace gauntlet
