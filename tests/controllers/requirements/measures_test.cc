// Each measure of a swarm whose places are known.
#include "controllers/requirements/measures.h"

#include <gmock/gmock.h>

#include "controllers/requirements/formula_reader.h"
#include "tests/controllers/requirements/recorded_run.h"

namespace gauntlet::controllers::requirements {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing_support::RecordedRun;

// Two robots a metre apart and one far away; after a second the far one has come to the others.
const RecordedRun& Meeting() {
  static const RecordedRun run(3, 19, [](sim::Tick tick, int robot) {
    if (robot < 2) return sim::Vec2(robot, 0.0);
    return tick < 10 ? sim::Vec2(-2.0, 2.5) : sim::Vec2(0.5, 0.0);
  });
  return run;
}

std::vector<double> Measured(std::string_view name, bool per_robot, Node node = {}) {
  for (const MeasureRow& row : MeasureRows()) {
    if (row.name == name && row.per_robot == per_robot) return row.measure(Meeting().trace(), node);
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(MeasuresTest, OfTheSwarm) {
  EXPECT_THAT(Measured("time", false), ElementsAre(0.0, 1.0));
  EXPECT_THAT(Measured("robots", false), ElementsAre(3.0, 3.0));
  EXPECT_THAT(Measured("center_x", false), ElementsAre(DoubleEq(-1.0 / 3), DoubleEq(0.5)));
  EXPECT_THAT(Measured("center_y", false), ElementsAre(DoubleEq(2.5 / 3), DoubleEq(0.0)));
  EXPECT_THAT(Measured("distance_to", false, {.place = Place::kGoal})[1], DoubleEq(1.5));
  EXPECT_THAT(Measured("distance_to", false, {.place = Place::kStart})[1], DoubleEq(2.5));
  EXPECT_THAT(Measured("distance_to", false, {.point = {0.5, 1.0}})[1], DoubleEq(1.0));
  EXPECT_THAT(Measured("dispersion", false)[1], DoubleEq(1.0 / 3));
  EXPECT_THAT(Measured("order", false), ElementsAre(DoubleEq(1.0), DoubleEq(1.0)));
  EXPECT_THAT(Measured("speed", false)[0], DoubleEq(0.05));
  EXPECT_THAT(Measured("largest_cluster", false, {.number = 1.5}), ElementsAre(2.0, 3.0));
  EXPECT_THAT(Measured("clusters", false, {.number = 0.4}), ElementsAre(3.0, 3.0));
  EXPECT_THAT(Measured("clusters", false, {.number = 1.5}), ElementsAre(2.0, 1.0));
}

TEST(MeasuresTest, OfEachRobot) {
  EXPECT_THAT(Measured("x", true), ElementsAre(0.0, 1.0, -2.0, 0.0, 1.0, 0.5));
  EXPECT_THAT(Measured("y", true), ElementsAre(0.0, 0.0, 2.5, 0.0, 0.0, 0.0));
  EXPECT_THAT(Measured("speed", true), testing::Each(0.05));
  EXPECT_THAT(Measured("distance_to", true, {.place = Place::kGoal}),
              ElementsAre(2.0, 1.0, DoubleEq(std::sqrt(16 + 6.25)), 2.0, 1.0, 1.5));
  EXPECT_THAT(Measured("distance_to", true, {.place = Place::kCenter})[5], DoubleEq(0.0));
  EXPECT_THAT(Measured("nearest", true), ElementsAre(1.0, 1.0, DoubleEq(std::sqrt(4 + 6.25)), 0.5, 0.5, 0.5));
}

TEST(MeasuresTest, LookAtRobotsUnderTestOnly) {
  Trace trace = Meeting().trace();
  trace.robots = {0, 1};
  for (const MeasureRow& row : MeasureRows()) {
    if (row.name == "center_x") EXPECT_THAT(row.measure(trace, {}), ElementsAre(0.5, 0.5));
    if (row.name == "robots") EXPECT_THAT(row.measure(trace, {}), ElementsAre(2.0, 2.0));
    if (row.name == "nearest") EXPECT_THAT(row.measure(trace, {}), ElementsAre(1.0, 1.0, 1.0, 1.0));
  }
}

TEST(MeasuresTest, StayWithinTheirRanges) {
  for (const MeasureRow& row : MeasureRows()) {
    const Trace trace = Meeting().trace();
    const Range range = row.range_of(trace);
    EXPECT_LT(range.low, range.high) << row.name;
    for (const double value : row.measure(trace, {.number = 1.0})) {
      EXPECT_GE(value, range.low) << row.name;
      EXPECT_LE(value, range.high) << row.name;
    }
  }
}

TEST(MeasuresTest, OfEachTick) {
  const Trace trace = Meeting().trace(1);
  for (const MeasureRow& row : MeasureRows()) {
    if (row.name == "time") EXPECT_EQ(row.measure(trace, {}).size(), 20U);
  }
}

TEST(MeasuresTest, AMetricHasTheRangeOfItsUnit) {
  const Trace trace = Meeting().trace();
  EXPECT_EQ(RangeOf({"a", "yes/no", {}, ""}, trace).high, 1.0);
  EXPECT_EQ(RangeOf({"a", "m", {}, ""}, trace).low, -RangeOf({"a", "m", {}, ""}, trace).high);
  EXPECT_DOUBLE_EQ(RangeOf({"a", "m^2", {}, ""}, trace).high, 5.9 * 5.9);
  EXPECT_DOUBLE_EQ(RangeOf({"a", "s", {}, ""}, trace).high, 1.9);
  EXPECT_EQ(RangeOf({"a", "", {}, ""}, trace).high, 3.0);
}

}  // namespace
}  // namespace gauntlet::controllers::requirements
