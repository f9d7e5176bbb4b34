#include "master/cases/argos_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/cases/case_file.h"

namespace gauntlet::master {
namespace {

using ::testing::HasSubstr;

sim::TestCase SomeCase() {
  sim::TestCase some;
  some.side_x = 6.0;
  some.side_y = 4.5;
  some.wall_thickness = 0.2;
  some.obstacles = {{0.1 + 0.2, -1.0 / 3, 1.6, 0.2, 322.0}, {-2.0, 1.0, 0.4, 0.4, 0.1}};
  return some;
}

void ExpectReadsBack(const sim::TestCase& written) {
  const Result<std::string> text = WriteArgos(written);
  ASSERT_TRUE(text.ok()) << text.error().message;
  const Result<LoadedCase> read = ParseArgos(*text, "c.argos");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const sim::TestCase& found = read->test_case;
  EXPECT_EQ(found.side_x, written.side_x);
  EXPECT_EQ(found.side_y, written.side_y);
  EXPECT_EQ(found.wall_thickness, written.wall_thickness);
  EXPECT_EQ(found.obstacles, written.obstacles);
  EXPECT_EQ(found.robots, written.robots);
  ASSERT_EQ(found.spawn_area.has_value(), written.spawn_area.has_value());
  if (!found.spawn_area) return;
  EXPECT_EQ(found.spawn_area->min, written.spawn_area->min);
  EXPECT_EQ(found.spawn_area->max, written.spawn_area->max);
}

TEST(ArgosExport, IsReadBackToTheBit) {
  ExpectReadsBack(SomeCase());
  ExpectReadsBack({});
}

TEST(ArgosExport, TakesRobotsWithTheirStartArea) {
  sim::TestCase some = SomeCase();
  some.robots = 7;
  some.spawn_area = sim::Rectangle{{1.25, 1.0}, {2.0, 1.75}};
  ExpectReadsBack(some);
}

TEST(ArgosExport, RefusesWhatSuchAFileCannotSay) {
  sim::TestCase moving = SomeCase();
  moving.obstacles[1].path = {{0.0, 0.0}};
  moving.obstacles[1].speed = 0.02;
  EXPECT_THAT(WriteArgos(moving).error().message, HasSubstr("obstacle 2 moves"));
  sim::TestCase lit = SomeCase();
  lit.obstacles[0].light = sim::Color::kRed;
  EXPECT_THAT(WriteArgos(lit).error().message, HasSubstr("obstacle 1"));
  sim::TestCase somewhere = SomeCase();
  somewhere.robots = 7;
  EXPECT_THAT(WriteArgos(somewhere).error().message, HasSubstr("how many robots"));
}

}  // namespace
}  // namespace gauntlet::master
