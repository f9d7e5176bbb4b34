#include "analysis/figures/heat_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

namespace gauntlet::analysis {
namespace {

using ::testing::HasSubstr;

TEST(DrawHeatMapTest, IsAWholeDocumentThatShowsEveryCount) {
  const HeatMap map{"types <b>",
                    "3 of 4",
                    "angle",
                    "speed",
                    {"0-10", "10-20"},
                    {"alike", "unlike"},
                    {{{0}, {7}}, {{1234}, {1}}}};
  const std::string svg = DrawHeatMap(map);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_THAT(svg, HasSubstr("types &lt;b&gt;"));
  EXPECT_EQ(document.select_nodes("//*[@class='cell']").size(), 4U);
  std::vector<std::string> counts;
  for (const auto& node : document.select_nodes("//*[@class='count']"))
    counts.emplace_back(node.node().child_value());
  EXPECT_THAT(counts, testing::ElementsAre("7", "1,234", "1"));
}

// The W3C's relative luminance and contrast of two colours "#rrggbb".
double Contrast(const std::string& a, const std::string& b) {
  const auto luminance = [](const std::string& color) {
    double sum = 0.0;
    const double weights[] = {0.2126, 0.7152, 0.0722};
    for (std::size_t i = 0; i < 3; ++i) {
      const double c = std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
      sum += weights[i] * (c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return sum;
  };
  const double x = luminance(a);
  const double y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

TEST(HeatColorsTest, TextIsReadableOnEveryShade) {
  for (std::uint64_t count = 0; count <= 200; ++count) {
    const HeatColors colors = HeatColorsOf(count, 200);
    EXPECT_GE(Contrast(colors.fill, colors.text), 4.5) << count << " " << colors.fill;
  }
}

TEST(HeatColorsTest, MoreIsDarker) {
  for (std::uint64_t count = 2; count <= 100; ++count) {
    EXPECT_GE(Contrast("#ffffff", HeatColorsOf(count, 100).fill),
              Contrast("#ffffff", HeatColorsOf(count - 1, 100).fill));
  }
}

}  // namespace
}  // namespace gauntlet::analysis
