#include "controllers/common/state_log.h"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(StateLog, LooksOncePerSecondAndMissesNoBriefState) {
  constexpr std::array<std::string_view, 3> kNames = {"a", "b", "c"};
  StateLog log(kNames);
  log.Begin(1, 100, 0);
  for (int tick = 1; tick <= 100; ++tick) log.Add(tick == 45 ? 2 : tick > 70 ? 1 : 0);
  EXPECT_EQ(log.ticks(), 101);
  const sim::Annotation plain = log.Line(0, std::nullopt);
  ASSERT_EQ(plain.points.size(), 2u);
  EXPECT_EQ(plain.points[1], sim::Vec2(8.0, 1.0));
  const sim::Annotation line = log.Line(0, 2);
  ASSERT_EQ(line.points.size(), 4u);
  EXPECT_EQ(line.points[1], sim::Vec2(5.0, 2.0));
  EXPECT_EQ(line.label, "a,b,c");
  std::vector<std::pair<std::string, double>> means;
  log.AddMeans(means);
  ASSERT_EQ(means.size(), 3u);
  EXPECT_EQ(means[1].first, "mean_robots_b");
  EXPECT_NEAR(means[1].second, 30.0 / 101.0, 1e-12);
  EXPECT_NEAR(means[0].second + means[1].second + means[2].second, 1.0, 1e-12);
}

}  // namespace
}  // namespace gauntlet::controllers
