#include "report/figures/condition_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/pages/facts.h"
#include "tests/report/swept_campaign.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<NamedFigure> FiguresOfSweep(const std::vector<std::string>& settings) {
  CampaignFacts facts = FactsOf("flocking");
  std::vector<SearchSummary> searches;
  for (const std::string& one : settings) searches.push_back(SearchOfCases(one, searches.size(), 10));
  facts.summary = SweptCampaign(searches);
  return ConditionFigures(facts);
}

TEST(ConditionFigure, IsDrawnOverTheNumbersOfTheKeyThatVariesFastest) {
  const auto figures = FiguresOfSweep({"a=x, b=1", "a=x, b=2.5", "a=y, b=1", "a=y, b=2.5"});
  ASSERT_THAT(figures, SizeIs(1));
  EXPECT_EQ(figures[0].name, "failures-by-condition");
  const std::string svg = figures[0].svg();
  EXPECT_THAT(svg, HasSubstr(">b<"));
  for (const char* line : {"a=x", "a=y"}) EXPECT_THAT(svg, HasSubstr(line));
  EXPECT_THAT(figures[0].csv(), HasSubstr("\"a=x, b=2.5\""));
}

TEST(ConditionFigure, NeedsSeveralSettingsWithNumbers) {
  EXPECT_THAT(FiguresOfSweep({"a=x", "a=y"}), IsEmpty());
  EXPECT_THAT(FiguresOfSweep({"seed 1", "seed 2"}), IsEmpty());
  EXPECT_THAT(FiguresOfSweep({"a=1", "b=2"}), IsEmpty());
}

}  // namespace
}  // namespace gauntlet
