// Covers: analysis/figures/arena_drawing.cc, analysis/figures/run/run_panel.cc,
// analysis/figures/run/run_tracks.cc, analysis/figures/run/trajectory_csv.cc, analysis/figures/svg_canvas.cc
#include "analysis/figures/run/run_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/layout_grid.h"
#include "analysis/figures/run/trajectory_csv.h"
#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<sim::AnnotationStyle> kStyles = {
    {"area", "", sim::Mark::kArea, "area the swarm starts in"},
    {"path", "", sim::Mark::kPlan, "planned path"},
    {"disc", "", sim::Mark::kGoal, ""},
    {"split", "", sim::Mark::kSplit, "last split, and who left then"},
    {"transfer", "", sim::Mark::kTransfer, "transfer"}};

// Three birds and a prey (robot 3) that walk from the upper right to the lower left; bird 1 stays behind.
RunFigure ThreeBirds() {
  RunFigure figure;
  figure.experiment = "flocking";
  figure.run = "run 12";
  figure.style = {.member = "bird", .guide = "prey", .annotations = kStyles};
  figure.spec.scenario = "flocking";
  figure.spec.controller = "flocking-original";
  figure.spec.seed = 18446744073709551615U;
  figure.spec.test_case.obstacles = {{0.0, 1.0, 1.0, 0.2, 0.0},     // inside
                                     {-3.0, 0.0, 2.0, 0.4, 0.0},    // half of it beyond the wall
                                     {2.0, -2.0, 0.6, 0.3, 45.0}};  // turned
  constexpr int kTicks = 400;
  for (int t = 0; t <= kTicks; ++t) {
    std::vector<sim::RobotState> states;
    for (int robot = 0; robot < 4; ++robot) {
      const double way = robot == 1 ? std::min(t, 150) : t;
      states.push_back({2.5 - 0.0125 * way, 2.5 - 0.0125 * way - 0.2 * robot, -2.356, 0.17});
    }
    figure.result.trajectory.push_back(states);
  }
  figure.result.ticks = kTicks;
  for (int robot = 0; robot < 4; ++robot) {
    const auto index = static_cast<std::size_t>(robot);
    sim::RobotSummary summary;
    summary.start = {figure.result.trajectory.front()[index].position(), -2.356};
    summary.end = {figure.result.trajectory.back()[index].position(), -2.356};
    summary.lost = robot == 1;
    summary.waypoints = {summary.start.position, summary.end.position};
    figure.result.robots.push_back(summary);
  }
  const sim::Vec2 prey_start = figure.result.robots[3].start.position;
  figure.result.annotations = {
      {"area", "start", {{2, 2}, {3, 2}, {3, 3}, {2, 3}}, 0.0, -1, {}},
      {"path", "plan", {prey_start, {0.0, 0.0}, {-2.5, -2.5}}, 0.0, -1, {}},
      {"disc", "goal", {{-2.5, -2.5}}, 0.15, -1, {}},
      {"split", "first", {{1.5, 1.5}}, 0.0, 40, {0}},
      {"split", "second", {{0.6, 0.6}}, 0.0, 151, {1}},
  };
  figure.metrics = {{"angular_order", "0.875"}};
  figure.result.fitness = 0.25;
  return figure;
}

pugi::xml_document Parse(const std::string& svg) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(svg.data(), svg.size());
  EXPECT_TRUE(parsed) << parsed.description() << " at byte " << parsed.offset;
  return document;
}

pugi::xpath_node_set Find(const pugi::xml_document& document, const std::string& path) {
  return document.select_nodes(path.c_str());
}

// Every text of the picture, one per line.
std::string Texts(const pugi::xml_document& document) {
  std::string texts;
  for (const auto& node : Find(document, "//text")) texts += std::string(node.node().text().get()) + "\n";
  return texts;
}

std::vector<std::pair<double, double>> PointsOf(const pugi::xml_node& node) {
  std::vector<std::pair<double, double>> points;
  std::istringstream stream(node.attribute("points").value());
  double x = 0.0;
  double y = 0.0;
  char comma = 0;
  while (stream >> x >> comma >> y) points.emplace_back(x, y);
  return points;
}

TEST(RunFigure, IsOneSelfContainedXmlDocument) {
  const std::string svg = DrawRun(ThreeBirds());
  const pugi::xml_document document = Parse(svg);
  EXPECT_STREQ(document.document_element().name(), "svg");
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_THAT(svg, Not(HasSubstr("href")));
  EXPECT_THAT(svg, Not(HasSubstr("@import")));
  EXPECT_THAT(svg, Not(HasSubstr("url(")));
}

TEST(RunFigure, SameFigureSameBytes) {
  EXPECT_EQ(DrawRun(ThreeBirds()), DrawRun(ThreeBirds()));
}

TEST(RunFigure, DrawsAndNumbersEveryObstacleClippedAtTheWall) {
  const pugi::xml_document document = Parse(DrawRun(ThreeBirds()));
  for (const char* id : {"obstacle-1", "obstacle-2", "obstacle-3"}) {
    EXPECT_EQ(Find(document, std::string("//polygon[@id='") + id + "']").size(), 1U) << id;
  }
  // 1, 2, 3, and the "1" of the legend.
  EXPECT_EQ(Find(document, "//text[@class='obstacle-number']").size(), 4U);

  // Obstacle 2 reaches from x = -4 to -2; what is drawn begins at the wall's inner face, x = -2.95. The scale
  // is that of obstacle 1: 1 m long.
  const auto inside = PointsOf(Find(document, "//polygon[@id='obstacle-1']").first().node());
  const auto clipped = PointsOf(Find(document, "//polygon[@id='obstacle-2']").first().node());
  const auto width = [](const std::vector<std::pair<double, double>>& points) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end());
    return most->first - least->first;
  };
  ASSERT_EQ(inside.size(), 4U);
  ASSERT_GE(clipped.size(), 4U);
  EXPECT_NEAR(width(clipped) / width(inside), 0.95, 1e-3);
}

TEST(RunFigure, ObstacleBeyondTheWallIsNotDrawn) {
  RunFigure figure = ThreeBirds();
  figure.spec.test_case.obstacles.push_back({5.0, 5.0, 1.0, 0.2, 0.0});
  const pugi::xml_document document = Parse(DrawRun(figure));
  EXPECT_TRUE(Find(document, "//polygon[@id='obstacle-4']").empty());
}

TEST(RunFigure, EveryRobotHasItsWayByItsFate) {
  const pugi::xml_document document = Parse(DrawRun(ThreeBirds()));
  EXPECT_EQ(Find(document, "//g[@class='way kept']").size(), 2U);
  EXPECT_EQ(Find(document, "//g[@class='way lost'][@id='robot-1']").size(), 1U);
  EXPECT_EQ(Find(document, "//g[@class='way guide'][@id='robot-3']").size(), 1U);
  // The lost bird's end and the legend's explanation of it.
  EXPECT_EQ(Find(document, "//circle[@class='ring']").size(), 2U);
}

TEST(RunFigure, WaysGrowStrongerWithTime) {
  const pugi::xml_document document = Parse(DrawRun(ThreeBirds()));
  double before = 0.0;
  int pieces = 0;
  for (const auto& piece : Find(document, "//g[@id='robot-0']/polyline")) {
    const double strength = piece.node().attribute("stroke-opacity").as_double();
    EXPECT_GT(strength, before);
    before = strength;
    ++pieces;
  }
  EXPECT_GE(pieces, 5);
}

TEST(RunFigure, WayBeginsAndEndsWhereTheRobotDid) {
  const pugi::xml_document document = Parse(DrawRun(ThreeBirds()));
  const auto pieces = Find(document, "//g[@id='robot-0']/polyline");
  const auto first = PointsOf(pieces[0].node()).front();
  const auto last = PointsOf(pieces[pieces.size() - 1].node()).back();
  // From (2.5, 2.5) to (-2.5, -2.5): the diagonal of a square.
  const auto obstacle = PointsOf(Find(document, "//polygon[@id='obstacle-1']").first().node());
  const auto [least, most] = std::minmax_element(obstacle.begin(), obstacle.end());
  const double scale = most->first - least->first;  // pixels per metre
  EXPECT_NEAR(first.first - last.first, 5.0 * scale, 0.05);
  EXPECT_NEAR(last.second - first.second, 5.0 * scale, 0.05);
}

TEST(RunFigure, OnlyTheLastSplitIsMarkedAndNamed) {
  const pugi::xml_document document = Parse(DrawRun(ThreeBirds()));
  EXPECT_THAT(Texts(document), HasSubstr("split at 15 s: bird 1 left the swarm\n"));
  EXPECT_THAT(Texts(document), Not(HasSubstr("split at 4 s")));
  EXPECT_EQ(Find(document, "//circle[@id='split']").size(), 1U);
}

TEST(RunFigure, ManyRobotsThatLeftAreNamedByRanges) {
  RunFigure figure = ThreeBirds();
  figure.result.annotations.back().robots = {9, 0, 1, 2, 5, 7, 8};
  EXPECT_THAT(Texts(Parse(DrawRun(figure))), HasSubstr("birds 0-2, 5, 7-9 left the swarm\n"));
  figure.result.annotations.back().robots = {3, 4};
  EXPECT_THAT(Texts(Parse(DrawRun(figure))), HasSubstr("birds 3, 4 left the swarm\n"));
}

TEST(RunFigure, WithoutSplitNothingIsMarked) {
  RunFigure figure = ThreeBirds();
  figure.result.annotations.resize(3);
  const pugi::xml_document document = Parse(DrawRun(figure));
  EXPECT_TRUE(Find(document, "//*[@id='split']").empty());
  EXPECT_THAT(Texts(document), Not(HasSubstr("split")));
}

TEST(RunFigure, TransfersAreMarkedAndCounted) {
  RunFigure figure = ThreeBirds();
  const std::string before = DrawRun(figure);
  EXPECT_EQ(before.find("transfer\""), std::string::npos);
  figure.result.annotations.push_back({"transfer", "transfer", {{0.5, 0.5}}, 0.0, 300, {1, 2}});
  figure.result.annotations.push_back({"transfer", "transfer", {{-0.5, 0.5}}, 0.0, 700, {2, 1}});
  figure.result.annotations.push_back({"transfer", "nowhere", {}, 0.0, 700, {2, 1}});
  const std::string svg = DrawRun(figure);
  std::size_t circles = 0;
  for (std::size_t at = svg.find("class=\"transfer\""); at != std::string::npos;
       at = svg.find("class=\"transfer\"", at + 1)) {
    ++circles;
  }
  EXPECT_EQ(circles, 2u * 2u + 2u) << "two per transfer, two in the legend";
  EXPECT_NE(svg.find("2 transfers of an item"), std::string::npos);
}

TEST(RunFigure, TellsTheOutcomeInWords) {
  RunFigure figure = ThreeBirds();
  EXPECT_EQ(DescribeOutcome(figure), "1 of 3 birds lost");
  figure.result.failure = {true, 12, "20-30 degrees apart"};
  EXPECT_EQ(DescribeOutcome(figure), "total failure: 1 of 3 birds lost");
  RunFigure required = figure;
  required.result.annotations.push_back({.kind = "violated", .label = "b: x < 1", .tick = 200});
  required.result.annotations.push_back({.kind = "violated", .label = "a: near >= 6", .tick = 155});
  EXPECT_EQ(DescribeOutcome(required), "total failure: a: near >= 6, at 15.5 s; 1 of 3 birds lost");
  required.style.lost = "";
  EXPECT_EQ(DescribeOutcome(required), "total failure: a: near >= 6, at 15.5 s");
  required.result.failure.total = false;
  EXPECT_EQ(DescribeOutcome(required), "no failure");
  RunFigure nobody_lost = figure;
  for (sim::RobotSummary& robot : nobody_lost.result.robots) robot.lost = false;
  nobody_lost.result.failure.label = "no path, no food";
  EXPECT_EQ(DescribeOutcome(nobody_lost), "total failure: no path, no food");
  RunFigure trapped = figure;  // where being trapped is no failure by itself
  trapped.style.lost_is_failure = false;
  trapped.style.lost = "trapped";
  trapped.result.failure.label = "no path";
  EXPECT_EQ(DescribeOutcome(trapped), "total failure: no path; 1 of 3 birds trapped");
  trapped.result.failure.label.clear();
  EXPECT_EQ(DescribeOutcome(trapped), "total failure by the scenario's own rule; 1 of 3 birds trapped");
  const std::string texts = Texts(Parse(DrawRun(figure)));
  EXPECT_THAT(texts, HasSubstr("flocking, run 12\n"));
  EXPECT_THAT(texts, HasSubstr("total failure: 1 of 3 birds lost\n"));
  EXPECT_THAT(texts, HasSubstr("fitness 0.250 after 40 s\n"));
  EXPECT_THAT(texts, HasSubstr("failure type 12: 20-30 degrees apart\n"));
  EXPECT_THAT(texts, HasSubstr("18446744073709551615\n"));
  EXPECT_THAT(texts, HasSubstr("angular order\n"));

  for (auto& robot : figure.result.robots) robot.lost = false;
  figure.result.failure = {};
  EXPECT_EQ(DescribeOutcome(figure), "no bird lost");
}

TEST(RunFigure, TheGuideIsTheRobotThatBeginsThePlannedPath) {
  RunFigure figure = ThreeBirds();
  EXPECT_EQ(GuideOf(figure), 3);
  figure.result.annotations[1].robots = {2};
  EXPECT_EQ(GuideOf(figure), 2);
  figure.result.annotations.clear();
  EXPECT_EQ(GuideOf(figure), -1);
}

TEST(RunFigure, SpeaksTheWordsOfTheScenario) {
  const std::string texts = Texts(Parse(DrawRun(ThreeBirds())));
  EXPECT_THAT(texts, HasSubstr("prey, travelled\n"));
  EXPECT_THAT(texts, HasSubstr("\nP\n"));
  EXPECT_THAT(texts, HasSubstr("planned path\n"));
  EXPECT_THAT(texts, HasSubstr("last split, and who left then\n"));
  EXPECT_THAT(texts, HasSubstr("area the swarm starts in\n"));
}

TEST(RunFigure, WhatTheScenarioDoesNotDeclareIsNotDrawn) {
  RunFigure figure = ThreeBirds();
  figure.style.annotations = {};
  const pugi::xml_document document = Parse(DrawRun(figure));
  EXPECT_THAT(Texts(document), Not(HasSubstr("split")));
  EXPECT_TRUE(Find(document, "//circle[@class='goal']").empty());
}

TEST(RunFigure, ARefusedRunStillShowsItsArena) {
  RunFigure figure;
  figure.experiment = "flocking";
  figure.run = "run 3";
  figure.spec.test_case.obstacles = {{0.0, 0.0, 6.0, 0.4, 0.0}};
  figure.result.verdict = sim::Verdict::kRefused;
  figure.result.message = "no-path: no way from <start> to goal";
  const pugi::xml_document document = Parse(DrawRun(figure));
  EXPECT_EQ(Find(document, "//polygon[@id='obstacle-1']").size(), 1U);
  EXPECT_THAT(Texts(document), HasSubstr("refused: no-path: no way from <start> to goal\n"));
}

TEST(RunFigure, WithoutTrajectoryTheWaypointsAreDrawn) {
  RunFigure figure = ThreeBirds();
  figure.result.trajectory.clear();
  const pugi::xml_document document = Parse(DrawRun(figure));
  EXPECT_FALSE(Find(document, "//g[@id='robot-0']/polyline").empty());
}

TEST(RunFigure, StrangeInputStaysAPicture) {
  RunFigure figure = ThreeBirds();
  figure.experiment = "a<b>&\"c\" \x01 \xff\xfe " + std::string(300, 'x');
  figure.result.trajectory[7][0].x = std::numeric_limits<double>::quiet_NaN();
  figure.result.trajectory[9].resize(2);
  figure.spec.test_case.side_x = 40.0;
  figure.spec.test_case.side_y = 0.5;
  figure.result.annotations.push_back({"split", "", {{0.0, 0.0}}, 0.0, 100000, {77, -4}});
  const std::string svg = DrawRun(figure);
  Parse(svg);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;&amp;&quot;c&quot; ? ??"));
}

TEST(EscapeXml, KeepsValidUtf8AndReplacesTheRest) {
  EXPECT_EQ(EscapeXml("f\u00fcr \u2192 \U0001F41F"), "f\u00fcr \u2192 \U0001F41F");
  EXPECT_EQ(EscapeXml("\xc0\xaf"), "??");        // overlong
  EXPECT_EQ(EscapeXml("\xed\xa0\x80"), "???");   // surrogate
  EXPECT_EQ(EscapeXml("\xef\xbf\xbf"), "???");   // U+FFFF is no XML character
  EXPECT_EQ(EscapeXml("end\xe2\x82"), "end??");  // cut off
  EXPECT_EQ(EscapeXml(std::string("a\0b", 3)), "a?b");
}

TEST(SvgNumber, IsShortAndNeverNegativeZero) {
  EXPECT_EQ(SvgNumber(12.0), "12");
  EXPECT_EQ(SvgNumber(0.505), "0.51");
  EXPECT_EQ(SvgNumber(-0.001), "0");
  EXPECT_EQ(SvgNumber(100.10), "100.1");
  EXPECT_EQ(SvgNumber(std::numeric_limits<double>::infinity()), "0");
}

TEST(TrajectoryCsv, OneLinePerTickAndRobotWithNumbersThatReadBack) {
  const std::string csv = WriteTrajectoryCsv(
      {{{0.1, -2.0, 0.0, 0.0}, {1.0 / 3.0, 0.0, 1.5, 0.0}}, {{0.2, -2.0, 0.0, 1.0}, {0.5, 0.0, 1.5, 0.08}}});
  EXPECT_EQ(csv,
            "tick,time_s,robot,x,y,heading,speed\n"
            "0,0.0,0,0.1,-2,0,0\n"
            "0,0.0,1,0.3333333333333333,0,1.5,0\n"
            "1,0.1,0,0.2,-2,0,1\n"
            "1,0.1,1,0.5,0,1.5,0.08\n");
  EXPECT_EQ(WriteTrajectoryCsv({}), "tick,time_s,robot,x,y,heading,speed\n");
}

TEST(RunFigureTest, MovingAndLitObstaclesShowTheirPathAndTheirLamps) {
  RunFigure figure = ThreeBirds();
  EXPECT_THAT(DrawRun(figure), Not(HasSubstr("class=\"obstacle-path\"")));
  EXPECT_THAT(DrawRun(figure), Not(HasSubstr("class=\"lamp\"")));
  figure.spec.test_case.obstacles[2].path = {{1.0, -1.0}};
  figure.spec.test_case.obstacles[2].speed = 0.02;
  figure.spec.test_case.obstacles[1].light = sim::Color::kMagenta;
  const std::string picture = DrawRun(figure);
  EXPECT_THAT(picture, HasSubstr("class=\"obstacle-path\" id=\"path-3\""));
  EXPECT_THAT(picture, HasSubstr("class=\"obstacle-end\""));
  EXPECT_THAT(picture, HasSubstr("way of a moving obstacle"));
  figure.spec.disturbances.faults = {{.robot = 3, .tick = 500}};
  EXPECT_THAT(DrawRun(figure), HasSubstr("3:stopped@500"));
  std::size_t lamps = 0;
  for (std::size_t at = picture.find("class=\"lamp\" fill=\"magenta\""); at != std::string::npos;
       at = picture.find("class=\"lamp\"", at + 1)) {
    ++lamps;
  }
  EXPECT_EQ(lamps, 2u) << "only its right side is inside the walls (half of it is beyond), and the legend";
}

TEST(LayoutGridTest, AnArenaElsewhereIsDrawnAlike) {
  LayoutGrid grid;
  grid.columns = grid.rows = {"all"};
  grid.arena.wall_thickness = 0.125;
  grid.layouts = {
      {.column = 0, .row = 0, .caption = "", .obstacles = {{0.5, 1.0, 1.0, 0.25, 30.0}}, .place = {}}};
  const std::string here = DrawLayoutGrid(grid);
  grid.arena.center = {16.0, -64.0};
  grid.layouts[0].obstacles = {{16.5, -63.0, 1.0, 0.25, 30.0}};
  EXPECT_EQ(DrawLayoutGrid(grid), here);
}

TEST(ArenaDrawingTest, AxesNameThePlacesOfTheArena) {
  sim::TestCase test_case;
  test_case.side_x = 0.5;
  test_case.side_y = 2.0;
  test_case.wall_thickness = 0.01;
  test_case.center = {10.0, -1.0};
  const FigureFrame frame(test_case);
  SvgCanvas canvas(frame.page_width(), frame.page_height(), "", "");
  DrawAxes(canvas, frame);
  const std::string svg = canvas.Take();
  for (const char* label : {">9.8<", ">10.0<", ">10.2<", ">0.0<", ">\u22122.0<"})
    EXPECT_THAT(svg, HasSubstr(label));
  for (const char* label : {">9.6<", ">0.2<", ">\u22122.2<"}) EXPECT_THAT(svg, Not(HasSubstr(label)));
}

}  // namespace
}  // namespace gauntlet::analysis
