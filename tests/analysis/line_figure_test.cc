// Covers: analysis/figures/run/swarm_motion.cc
#include "analysis/figures/line_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <pugixml.hpp>

#include "analysis/figures/run/swarm_motion.h"
#include "analysis/figures/value_axis.h"

namespace gauntlet::analysis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

pugi::xml_document Drawn(const LineFigure& figure) {
  const std::string svg = DrawLines(figure);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg.c_str()));
  return document;
}

TEST(DrawLinesTest, HasALineAndABandForEach) {
  const FigureLine line{"mean <&>", {1, 2, 3}, {5, 6, 7}, {4, 5, 6}, {6, 7, 8}};
  const auto document = Drawn({"t", "o", "runs", {{.axis_name = "fitness", .lines = {line, line}}}});
  EXPECT_EQ(document.select_nodes("//*[@class='line']").size(), 2U);
  EXPECT_EQ(document.select_nodes("//*[@class='band']").size(), 2U);
  EXPECT_STREQ(document.select_node("//*[@class='label']").node().child_value(), "mean <&>");
}

TEST(DrawLinesTest, ValuesThatAreMissingLeaveAGap) {
  const FigureLine line{"x", {1, 2, 3, 4, 5}, {1, 2, kNone, 4, 5}};
  const auto document = Drawn({"t", "", "", {{.axis_name = "", .lines = {line}}}});
  EXPECT_EQ(document.select_nodes("//*[@class='line']").size(), 2U);
  EXPECT_EQ(document.select_nodes("//*[@class='label']").size(), 1U);
}

TEST(DrawLinesTest, TakesNothingAndASingleValue) {
  Drawn({"t", "", "", {{.axis_name = "a", .lines = {}}}});
  Drawn({"t",
         "",
         "",
         {{.axis_name = "a",
           .lines = {{.name = "x", .x = {3}, .y = {3}}, {.name = "y", .x = {3}, .y = {kNone}}}}}});
}

TEST(RoundValuesTest, AreMultiplesOfARoundStep) {
  EXPECT_THAT(RoundValues(0.0, 1.0, 5),
              ElementsAre(0.0, 0.2, testing::DoubleEq(0.4), testing::DoubleEq(0.6), 0.8, 1.0));
  EXPECT_THAT(RoundValues(-7.0, 11.0, 4), ElementsAre(-5.0, 0.0, 5.0, 10.0));
  EXPECT_THAT(RoundValues(0.0, 1000.0, 8), testing::SizeIs(6));
}

TEST(SwarmMotionTest, TellsSpreadAgreementAndSpeed) {
  RunFigure figure;
  // Two robots, 2 m apart, both heading along x at 0.1 m/s.
  for (int tick = 0; tick <= 20; ++tick) {
    figure.result.trajectory.push_back({{0.01 * tick, -1.0, 0.0, 0.1}, {0.01 * tick, 1.0, 0.0, 0.1}});
  }
  figure.result.robots.resize(2);
  const LineFigure motion = SwarmMotion(figure);
  ASSERT_EQ(motion.panels.size(), 3U);
  EXPECT_DOUBLE_EQ(motion.panels[0].lines[0].y.back(), 1.0);
  EXPECT_DOUBLE_EQ(motion.panels[1].lines[0].y.back(), 1.0);
  EXPECT_NEAR(motion.panels[2].lines[0].y.back(), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(motion.panels[2].lines[0].y.front(), 0.0);
  EXPECT_DOUBLE_EQ(motion.panels[0].lines[0].x.back(), 2.0);
}

}  // namespace
}  // namespace gauntlet::analysis
