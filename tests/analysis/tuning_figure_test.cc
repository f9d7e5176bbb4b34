#include "analysis/figures/tuning_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

namespace gauntlet::analysis {
namespace {

using ::testing::HasSubstr;

std::vector<pugi::xml_node> OfClass(const pugi::xml_document& document, const std::string& name) {
  std::vector<pugi::xml_node> nodes;
  for (const auto& found : document.select_nodes(("//*[@class='" + name + "']").c_str()))
    nodes.push_back(found.node());
  return nodes;
}

TEST(DrawRobustnessTest, SetsEveryValueInItsPlaceOverTheThresholds) {
  const std::string svg = DrawRobustness({"tuning <1>",
                                          "outcome",
                                          "easier",
                                          "tougher",
                                          {{"genes",
                                            {{"4", "median 0.3", false, 0.2, Interval{0.1, 0.3}, true},
                                             {"8", "median 0.2", true, 0.5, {}, false}}},
                                           {"crossover", {{"uniform", "", false, 0.6, {}, false}}}}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_THAT(svg, HasSubstr("tuning &lt;1&gt;"));
  const auto beyond = OfClass(document, "point-beyond");
  const auto within = OfClass(document, "point");
  const auto baseline = OfClass(document, "baseline");
  ASSERT_EQ(beyond.size(), 1U);
  ASSERT_EQ(within.size(), 1U);
  ASSERT_EQ(baseline.size(), 1U);
  const auto x = [](const pugi::xml_node& node) { return node.attribute("cx").as_double(); };
  EXPECT_NEAR((x(baseline[0]) - x(beyond[0])) / (x(within[0]) - x(baseline[0])), 3.0, 1e-6);
  EXPECT_LT(baseline[0].attribute("cy").as_double(), within[0].attribute("cy").as_double());
  EXPECT_EQ(OfClass(document, "interval-beyond").size(), 1U);
  EXPECT_EQ(OfClass(document, "threshold").size(), 6U);
}

TEST(DrawConsistencyTest, DrawsTheLargestAndTheMedianOfEverySize) {
  const std::string svg = DrawConsistency({"consistency", "enough: 5", {{1, 1.0, 1.0}, {5, 0.54, 0.66}}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  const auto largest = OfClass(document, "largest");
  ASSERT_EQ(largest.size(), 3U) << "a line and two points";
  EXPECT_LT(largest[1].attribute("cy").as_double(), largest[2].attribute("cy").as_double());
  EXPECT_THAT(svg, HasSubstr("repeats in each set"));
}

}  // namespace
}  // namespace gauntlet::analysis
