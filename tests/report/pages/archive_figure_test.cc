// Covers: analysis/figures/layout_grid.cc, report/tables/summary_tables.cc
#include "report/figures/archive_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/report/pages/facts.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// An archive of two cells: one obstacle in the lowest left one, two in the middle.
CampaignFacts TwoCells() {
  CampaignFacts facts = FactsOf("flocking");
  const sim::ObstacleGene gene{.x = -2.0, .y = -2.0, .length = 1.5, .width = 0.2, .orientation_deg = 45.0};
  for (const auto& [id, obstacles] : {std::pair<IndividualId, std::size_t>(7, 1), {9, 2}}) {
    PopulationMember& member = facts.summary.searches[0].population.emplace_back();
    member.id = id;
    member.genome.assign(obstacles, gene);
  }
  facts.summary.searches[0].archive = {
      .axes = {{"split_x", -3.0, 3.0, 5}, {"split_y", -3.0, 3.0, 5}},
      .failures = {{{0, 0}, {-2.0, -2.1}, 7, 3, 3}, {{2, 2}, {0.1, 0.2}, 9, 4, 5}}};
  return facts;
}

TEST(ArchiveFigureTest, DrawsTheLayoutOfEachCellWithItsCounts) {
  const std::vector<NamedFigure> figures = ArchiveFigures(TwoCells());
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures.front().name, "archive");
  pugi::xml_document document;
  const std::string svg = figures.front().svg();
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(document.select_nodes("//*[@class='cell']").size(), 25U);
  EXPECT_EQ(document.select_nodes("//*[@class='place']").size(), 2U);
  std::vector<std::string> captions;
  for (const auto& node : document.select_nodes("//*[@class='caption']"))
    captions.emplace_back(node.node().child_value());
  EXPECT_THAT(captions, ElementsAre("1 obstacle: 3 of 3", "2 obstacles: 4 of 5"));
  EXPECT_THAT(svg, HasSubstr("2 of 25 cells"));
  EXPECT_EQ(figures.front().csv(),
            "column,row,test case,obstacles,length_m,failed,runs,split_x,split_y\n"
            "0,0,7,1,1.5,3,3,-2,-2.1\n2,2,9,2,3,4,5,0.1,0.2\n");
}

TEST(ArchiveFigureTest, ThereIsNoneOfASearchWithoutAnArchiveOrWithAnEmptyOne) {
  EXPECT_TRUE(ArchiveFigures(FactsOf("flocking")).empty());
  CampaignFacts empty = TwoCells();
  empty.summary.searches[0].archive.failures.clear();
  EXPECT_TRUE(ArchiveFigures(empty).empty());
}

}  // namespace
}  // namespace gauntlet
