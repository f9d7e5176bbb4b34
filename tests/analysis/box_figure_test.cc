#include "analysis/figures/box_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

namespace gauntlet::analysis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

NamedBox Box(const std::string& name, const std::vector<double>& values) {
  return {name, MakeBoxPlot(values), Describe(values).mean, values.size()};
}

std::size_t Count(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(DrawBoxesTest, IsAWholeDocumentThatNamesSetsAndRule) {
  const std::string svg = DrawBoxes({"fitness",
                                     "A = 0.2",
                                     "fitness, m",
                                     {Box("evolved <1>", {1, 2, 3, 4, 100}), Box("random", {5, 6, 7, 8})}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_THAT(svg, HasSubstr("evolved &lt;1&gt;"));
  EXPECT_THAT(svg, HasSubstr("n = 5"));
  EXPECT_THAT(svg, HasSubstr("Tukey"));
  EXPECT_EQ(Count(svg, "class=\"box\""), 2U);
  EXPECT_EQ(Count(svg, "class=\"outlier\""), 1U);
}

TEST(DrawBoxesTest, EqualValuesHaveAnAxisToo) {
  const std::string svg = DrawBoxes({"t", "", "x", {Box("a", {0, 0, 0}), Box("b", {0})}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, HasSubstr("class=\"value\""));
}

TEST(DrawBoxesTest, ManyOutliersInOnePlaceAreDrawnOnce) {
  std::vector<double> values(100, 1.0);
  values.insert(values.end(), 10, 50.0);
  EXPECT_EQ(Count(DrawBoxes({"t", "", "x", {Box("a", values)}}), "class=\"outlier\""), 1U);
}

}  // namespace
}  // namespace gauntlet::analysis
