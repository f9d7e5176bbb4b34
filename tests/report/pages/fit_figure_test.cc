// Covers: analysis/figures/pairs_figure.cc
#include "report/figures/settings/fit_figure.h"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/report/pages/facts.h"
#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

CampaignFacts ThreeDraws() {
  CampaignFacts facts = FactsOf("flocking");
  facts.fit.emplace();
  facts.fit->plan =
      ToyPlan({.vary = kToyVary, .targets = "metric=fitness value=1 n=100", .runs = 5000}).value();
  facts.fit->draws = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.5, 1.0, 0.0}};
  facts.fit->accepted = {{{0.5, 1.0, 0.0}, 1.0 / 3.0}, {{0.1, 0.2, 0.3}, 2.0 / 3.0}};
  facts.fit->chosen = SettingsPoint{0.5, 1.0, 0.0};
  return facts;
}

TEST(FitFigureTest, DrawsEveryKeyAndEveryTwoOfThem) {
  const std::vector<NamedFigure> figures = FitFigures(ThreeDraws());
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures.front().name, "settings");
  pugi::xml_document document;
  const std::string svg = figures.front().svg();
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(document.select_nodes("//*[@class='square']").size(), 6U);
  EXPECT_EQ(document.select_nodes("//*[@class='draw']").size(), 9U)
      << "three points in each of three squares";
  EXPECT_EQ(document.select_nodes("//*[@class='part']").size(), 6U) << "two bars in each of three squares";
  EXPECT_EQ(document.select_nodes("//*[@class='chosen']").size(), 6U);
  EXPECT_EQ(figures.front().csv(),
            "weight,controller_parameters.turn_rate,controller_parameters.bird_speed,"
            "controller_parameters.turning_speed_factor\n"
            "0.3333333333333333,1.0,0.1,0.0\n0.6666666666666666,0.6,0.015848931924611127,0.3\n");
}

TEST(FitFigureTest, ThereIsNoneOfACampaignThatIsNoFit) {
  EXPECT_TRUE(FitFigures(FactsOf("flocking")).empty());
}

}  // namespace
}  // namespace gauntlet
