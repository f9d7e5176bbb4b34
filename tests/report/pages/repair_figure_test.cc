// Covers: report/figures/settings/settings_answer.cc
#include "report/figures/settings/repair_figure.h"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "report/figures/settings/settings_answer.h"
#include "tests/report/pages/facts.h"
#include "tests/study/repairs/repaired_swarm.h"

namespace gauntlet {
namespace {

TEST(RepairFigureTest, DrawsACurveForEachParameter) {
  CampaignFacts facts = FactsOf("flocking");
  EXPECT_FALSE(SettingsAnswerOf(facts).has_value());
  facts.repair = testing_support::RepairedSwarm(testing_support::FactorIsAtFault);
  const SettingsAnswer answer = SettingsAnswerOf(facts).value();
  EXPECT_EQ(answer.outcome, OutcomeOf(*facts.repair));
  ASSERT_EQ(answer.figures.size(), 2U);
  EXPECT_EQ(answer.figures.front().name, "repair-1");
  pugi::xml_document document;
  const std::string svg = answer.figures.front().svg();
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(document.select_nodes("//*[contains(@class, 'line')]").size(), 3U);
  EXPECT_EQ(document.select_nodes("//*[contains(@class, 'band')]").size(), 1U);
  EXPECT_EQ(answer.figures.front().csv().substr(0, 60),
            "controller_parameters.turning_speed_factor,failed,runs\n0,12,");
}

TEST(RepairFigureTest, ThereIsNoneOfACampaignThatIsNoRepair) {
  EXPECT_TRUE(RepairFigures(FactsOf("flocking")).empty());
}

}  // namespace
}  // namespace gauntlet
