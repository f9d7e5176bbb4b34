#include "report/figures/settings/margin_figure.h"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "search/search_table.h"
#include "tests/report/pages/facts.h"

namespace gauntlet {
namespace {

CampaignFacts OneMargin() {
  CampaignFacts facts = FactsOf("flocking");
  Experiment experiment = facts.plans.front().experiment;
  experiment.margin.vary = "noise.wheels.gaussian=0..1";
  Margin margin{.experiment = experiment,
                .plan = MakeMarginPlan(experiment, AllKeysOf(experiment), 200).value()};
  margin.estimate = {
      .low = 0.2,
      .high = 0.6,
      .estimate = 0.4,
      .levels = {{0.0, 20, 2, 0.1}, {0.2, 20, 8, 0.375}, {0.4, 20, 7, 0.375}, {1.0, 20, 20, 1.0}}};
  facts.margins = {margin};
  return facts;
}

TEST(MarginFigureTest, DrawsTheFitWithItsBandAndTheShare) {
  const std::vector<NamedFigure> figures = MarginFigures(OneMargin());
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures.front().name, "margin-1");
  pugi::xml_document document;
  const std::string svg = figures.front().svg();
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(document.select_nodes("//*[contains(@class, 'line')]").size(), 2U);
  EXPECT_EQ(document.select_nodes("//*[contains(@class, 'band')]").size(), 1U);
  EXPECT_EQ(figures.front().csv(),
            "noise.wheels.gaussian,failed,runs,share,monotone fit\n"
            "0,2,20,0.1,0.1\n0.2,8,20,0.4,0.375\n0.4,7,20,0.35,0.375\n1,20,20,1,1\n");
}

TEST(MarginFigureTest, ThereIsNoneOfACampaignThatIsNoMargin) {
  EXPECT_TRUE(MarginFigures(FactsOf("flocking")).empty());
}

}  // namespace
}  // namespace gauntlet
