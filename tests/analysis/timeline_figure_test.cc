// Covers: analysis/figures/run/run_annotations.cc
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "analysis/figures/run/run_annotations.h"

namespace gauntlet::analysis {
namespace {

using ::testing::HasSubstr;

const std::vector<sim::AnnotationStyle> kTimelineStyles = {
    {"beacon", "", sim::Mark::kBeacon, "beacon at the end"},
    {"states", "beacon", sim::Mark::kFormerBeacon, "beacon earlier"},
    {"chain", "", sim::Mark::kChain, ""},
    {"disc", "nest", sim::Mark::kNest, ""},
    {"disc", "food", sim::Mark::kFood, ""}};

// Two robots, 100 s: one goes home twice for one second each, one stands as a beacon and is trapped later.
RunFigure TwoForagers() {
  RunFigure figure;
  figure.experiment = "foraging";
  figure.run = "run 7";
  figure.style = {.lost = "trapped", .annotations = kTimelineStyles};
  figure.result.ticks = 1000;
  figure.result.robots.resize(2);
  figure.result.robots[1].lost = true;
  figure.result.robots[1].end.position = {1.0, 1.0};
  for (int tick = 0; tick <= 1000; ++tick) {
    figure.result.trajectory.push_back({{0.001 * tick, 0.0, 0.0, 0.01}, {1.0, 0.001 * tick, 0.0, 0.01}});
  }
  figure.result.annotations = {
      {"disc", "nest", {{0.0, -2.0}}, 0.5, -1, {}},
      {"disc", "food", {{0.0, 2.0}}, 0.25, -1, {}},
      {"chain", "first path of beacons", {{0.0, -2.0}, {1.0, 0.3}, {0.0, 2.0}}, 0.0, 300, {}},
      {"trapped", "trapped with an item", {}, 0.0, 400, {1}},
      {"states",
       "wandering,homing,beacon",
       {{0.0, 0.0}, {20.0, 1.0}, {21.0, 0.0}, {50.0, 1.0}, {51.0, 2.0}},
       0.0,
       -1,
       {0}},
      {"states", "wandering,homing,beacon", {{0.0, 2.0}, {30.0, 0.0}}, 0.0, -1, {1}},
      {"beacon", "beacon", {{1.0, 0.0}}, 0.0, 1000, {0}},
  };
  return figure;
}

pugi::xml_document ParseSvg(const std::string& svg) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(svg.data(), svg.size());
  EXPECT_TRUE(parsed) << parsed.description() << " at byte " << parsed.offset;
  return document;
}

std::string TextsOf(const pugi::xml_document& document) {
  std::string texts;
  for (const auto& node : document.select_nodes("//text"))
    texts += std::string(node.node().text().get()) + "\n";
  return texts;
}

TEST(RobotStates, AreSpellsWithoutGapsThatEndWithTheRun) {
  const RobotStates states = StatesOf(TwoForagers().result);
  ASSERT_EQ(states.names, (std::vector<std::string>{"wandering", "homing", "beacon"}));
  ASSERT_EQ(states.spells.size(), 7U);
  EXPECT_EQ(states.robots, 2);
  EXPECT_EQ(states.spells[1].state, 1);
  EXPECT_EQ(states.spells[1].begin, 20.0);
  EXPECT_EQ(states.spells[1].end, 21.0);
  EXPECT_EQ(states.spells[4].end, 100.0);
  EXPECT_EQ(states.spells[6].robot, 1);
  EXPECT_EQ(states.spells[6].begin, 30.0);
}

TEST(RobotStates, NonsenseIsLeftOut) {
  RunFigure figure = TwoForagers();
  figure.result.annotations = {
      {"states", "a,b", {{0.0, 0.0}, {5.0, 2.0}, {7.0, -1.0}, {200.0, 1.0}}, 0.0, -1, {0}},
      {"states", "a,b", {{0.0, 0.0}}, 0.0, -1, {}},
      {"states", "a,b", {{0.0, 0.0}}, 0.0, -1, {-4}}};
  const RobotStates states = StatesOf(figure.result);
  ASSERT_EQ(states.spells.size(), 1U);
  EXPECT_EQ(states.spells[0].end, 100.0);
}

TEST(Timeline, HasARowPerRobotAndABarPerSpell) {
  const pugi::xml_document document = ParseSvg(DrawTimeline(TwoForagers()));
  const auto bars = document.select_nodes("//rect[@class='spell']");
  ASSERT_EQ(bars.size(), 7U);
  EXPECT_EQ(document.select_nodes("//text[@class='row']").size(), 2U);
  EXPECT_NEAR(bars[0].node().attribute("width").as_double(), 0.2 * 800, 0.01) << "20 of 100 s";
  for (const auto& bar : bars) EXPECT_GE(bar.node().attribute("width").as_double(), 3.0);
  EXPECT_EQ(TextsOf(document),
            "foraging, run 7\n1 of 2 robots trapped\nfitness 0.000 after 100 s\nWHAT EVERY ROBOT DID\nHOW "
            "MANY ROBOTS DID WHAT\nrobot 0\nrobot 1\ntrapped with an "
            "item\n0\n1\n2\n0\n10\n20\n30\n40\n50\n60\n70\n80\n90\n100\ntime (s)\nSTATE\nMEAN "
            "ROBOTS\nwandering\n1.2\nhoming\n0.0\nbeacon\n0.8\n");
}

TEST(Timeline, MarksTheTrappedFromThenOn) {
  const pugi::xml_document document = ParseSvg(DrawTimeline(TwoForagers()));
  const auto marks = document.select_nodes("//rect[@class='trapped']");
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_NEAR(marks[0].node().attribute("width").as_double(), 0.6 * 800, 0.01);
}

TEST(Timeline, RunsWithoutStatesHaveNone) {
  RunFigure figure = TwoForagers();
  EXPECT_TRUE(HasTimeline(figure));
  figure.result.annotations.resize(4);
  EXPECT_FALSE(HasTimeline(figure));
}

TEST(Timeline, SameFigureSameBytes) {
  EXPECT_EQ(DrawTimeline(TwoForagers()), DrawTimeline(TwoForagers()));
}

TEST(ForagingPicture, ShowsNestFoodBeaconsPathAndTheLoopOfTheTrapped) {
  const pugi::xml_document document = ParseSvg(DrawRun(TwoForagers()));
  const auto count = [&](const char* path) { return document.select_nodes(path).size(); };
  EXPECT_EQ(count("//circle[@class='nest']"), 2U) << "the place and the legend";
  EXPECT_EQ(count("//circle[@class='food']"), 2U);
  EXPECT_EQ(count("//polyline[@class='chain']"), 1U);
  EXPECT_EQ(count("//polygon[@class='beacon']"), 2U) << "robot 0 ends as a beacon";
  EXPECT_EQ(count("//polygon[@class='beacon-before']"), 2U) << "robot 1 was one";
  EXPECT_EQ(count("//g[@id='robot-1']/polyline[@class='loop']"), 1U);
  EXPECT_EQ(count("//g[@id='robot-0']/polyline[@class='loop']"), 0U);
  EXPECT_THAT(TextsOf(document), HasSubstr("1 of 2 robots trapped"));
  EXPECT_THAT(TextsOf(document), HasSubstr("first path of beacons, at 30 s\n"));
}

}  // namespace
}  // namespace gauntlet::analysis
