#include "study/sets/set_pair.h"

#include <gtest/gtest.h>

#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

// One run of each of these cases, which are numbered; all alone, or of one evolution.
RunSet SetOf(const std::vector<std::pair<std::uint64_t, double>>& runs, bool related = false) {
  RunSet set;
  set.values.name = "a set";
  for (const auto& [hash, value] : runs) {
    if (set.values.clusters.empty() || !related) set.values.clusters.emplace_back();
    set.values.clusters.back().push_back(value);
    set.cases.push_back({hash, set.values.clusters.size() - 1, value, 1});
  }
  set.origins = {{"c", testing_support::Flocking(), "1", {}}};
  return set;
}

SetPair Held(const RunSet& first, const RunSet& second, Pairing pairing = Pairing::kWhereShared) {
  return HoldAgainst(first, second, "fitness", "set 1", "set 2", pairing).value();
}

TEST(HoldAgainst, PairsWhereAllCasesOfTheSmallerSetAreShared) {
  const SetPair pair =
      Held(SetOf({{1, 0.1}, {2, 0.2}, {3, 0.3}}), SetOf({{3, 0.5}, {1, 0.4}, {2, 0.4}, {9, 0.0}}));
  ASSERT_TRUE(pair.paired.has_value());
  EXPECT_EQ(
      pair.words,
      "Both sets are of the same 3 cases, so they are compared case by case. set 1 less set 2 is -0.233 "
      "(-0.377 to -0.090); set 1 is larger in 0, smaller in 3; p = 0.25 (Wilcoxon signed ranks, exact). 1 "
      "case "
      "of one set alone: left out.");
}

TEST(HoldAgainst, PairsOthersOnDemandOnly) {
  const RunSet first = SetOf({{1, 0.1}, {2, 0.2}});
  const RunSet half = SetOf({{2, 0.5}, {3, 0.4}});
  EXPECT_FALSE(Held(first, half).paired.has_value());
  EXPECT_EQ(Held(first, half, Pairing::kDemanded).left_out, 2U);
  EXPECT_FALSE(Held(first, first, Pairing::kNever).paired.has_value());
  EXPECT_EQ(HoldAgainst(first, SetOf({{7, 1.0}}), "fitness", "1", "2", Pairing::kDemanded).error().message,
            "--paired: no case is one of both sets, so nothing can be paired");
}

// Copies in a population stand for themselves.
TEST(HoldAgainst, PairsCopiesAsOftenAsBothHaveThem) {
  const RunSet population = SetOf({{1, 0.1}, {1, 0.2}, {2, 0.3}}, /*related=*/true);
  const SetPair pair = Held(population, population);
  EXPECT_EQ(pair.paired->cases, 3U);
  EXPECT_TRUE(pair.paired->relatives);
  EXPECT_EQ(pair.p, std::nullopt);
}

TEST(HoldAgainst, KnowsWhatIsYesOrNo) {
  const auto total = [](const RunSet& one, const RunSet& other) {
    return HoldAgainst(one, other, "total_failure", "set 1", "set 2").value();
  };
  const SetPair pair = total(SetOf({{1, 1}, {2, 0}}), SetOf({{1, 0}, {2, 0}}));
  EXPECT_EQ(pair.p_by, "McNemar, exact");
  EXPECT_EQ(total(SetOf({{1, 1}, {2, 0}}), SetOf({{3, 0}, {4, 0}})).p_by, "Fisher, exact");
}

}  // namespace
}  // namespace gauntlet
