// Covers: report/pages/comparison_html.cc
#include "report/figures/set_comparison.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "report/pages/campaign_pages.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

// Few values: asymptotic and exact p differ.
TEST(SetComparisonTest, TableAndWordsNameTheSameP) {
  const testing_support::TemporaryDirectory scratch;
  std::ofstream(scratch / "a.csv") << "fitness\n0.1\n0.2\n0.3\n0.4\n";
  std::ofstream(scratch / "b.csv") << "fitness\n0.35\n0.5\n0.6\n0.7\n";
  const Result<SetComparisons> compared = CompareSets({scratch / "a.csv", scratch / "b.csv"});
  ASSERT_TRUE(compared) << compared.error().message;
  ASSERT_EQ(compared->comparisons.size(), 1U);
  const ComparedPair& pair = compared->comparisons.front().pairs.at(0);
  ASSERT_NE(pair.held.p, pair.held.comparison.test.p_two_sided);
  EXPECT_EQ(pair.p_adjusted, pair.held.p) << "of a single test";
  const std::string p = fmt::format("{:.2g}", pair.held.p.value());
  EXPECT_THAT(pair.held.words, HasSubstr("p = " + p));
  EXPECT_THAT(ComparisonHtml(compared->comparisons, {}), HasSubstr("<td class=\"number\">" + p + "</td>"));
}

}  // namespace
}  // namespace gauntlet
