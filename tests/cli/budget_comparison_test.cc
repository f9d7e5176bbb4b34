#include "cli/output/budget_comparison.h"
#include "tests/support/golden.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Searches of 1,000 runs that found confirmed cases of two obstacles in 1, 2, 3, ... cells, one every ten
// runs.
YieldSet Growing(const std::string& name, std::size_t searches, std::size_t first) {
  YieldSet set{.name = name, .title = "archive search", .searches = {}};
  for (std::size_t i = 0; i < searches; ++i) {
    SearchYield yield{.place = name, .experiment = {}, .runs = 1000, .cases = first + i + 1, .confirmed = {}};
    for (std::size_t cell = 0; cell < first + i; ++cell)
      yield.confirmed.push_back({cell, 2, 10 * (cell + 1)});
    set.searches.push_back(yield);
  }
  return set;
}

TEST(BudgetComparisonTest, GivesMediansMeansAndTheTestAgainstTheFirst) {
  const OrderedJson json = BudgetJson({Growing("many", 4, 5), Growing("few", 4, 1)});
  const OrderedJson& many = json["sets"][0];
  EXPECT_EQ(json["runs"], 1000);
  EXPECT_EQ(many["cases"], 30);
  EXPECT_EQ(many["confirmed"], 26);
  EXPECT_EQ(many["cells"]["values"], OrderedJson({5, 6, 7, 8}));
  EXPECT_EQ(many["cells"]["median"], 6.5);
  EXPECT_EQ(many["cells_with_up_to_2"]["mean"], 6.5);
  EXPECT_EQ(many["cells_with_1"]["mean"], 0.0);
  EXPECT_EQ(many["runs_until_5_cells_with_up_to_3"]["mean"], 50.0);
  EXPECT_FALSE(many["cells"].contains("p"));
  // All 4 of the first exceed all 4 of the second: 2 of 70 orders are so extreme.
  EXPECT_NEAR(json["sets"][1]["cells"]["p"].get<double>(), 2.0 / 70, 1e-12);
  EXPECT_EQ(json["sets"][1]["cells_with_1"]["p"], 1.0);
}

TEST(BudgetComparisonTest, SeveralTestsAreAdjusted) {
  const OrderedJson json = BudgetJson({Growing("many", 4, 5), Growing("few", 4, 1), Growing("too", 4, 1)});
  EXPECT_NEAR(json["sets"][1]["cells"]["p"].get<double>(), 2 * 2.0 / 70, 1e-12);
}

TEST(BudgetComparisonTest, WhatWasNeverReachedHasNoMean) {
  const OrderedJson json = BudgetJson({Growing("few", 3, 4)});  // 4, 5 and 6 cells
  const OrderedJson& runs = json["sets"][0]["runs_until_5_cells_with_up_to_3"];
  EXPECT_EQ(runs["values"], OrderedJson({nullptr, 50, 50}));
  EXPECT_EQ(runs["median"], 50);
  EXPECT_TRUE(runs["mean"].is_null());
  EXPECT_TRUE(json["sets"][0]["runs_until_10_cells_with_up_to_3"]["median"].is_null());
  testing_support::ExpectGolden("tests/cli/texts/budget_comparison_what_was_never_reached_has_no_mean.txt",
                                BudgetText({Growing("few", 3, 4)}));
}

}  // namespace
}  // namespace gauntlet
