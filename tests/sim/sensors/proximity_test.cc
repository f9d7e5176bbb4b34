#include "sim/sensors/proximity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "sim/geometry/ray_cast.h"
#include "sim/robot/controller.h"
#include "tests/sim/argos_csv.h"
#include "tests/sim/sensors/sensing.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

using testing::Each;

constexpr double kGapStep = 0.001;  // m, of both sweeps

BodyFrame FrameFacing(double x, double y, double heading_deg) {
  return BodyFrame(Pose{{x, y}, WrapAngle(heading_deg * kDegree)});
}

ProximityReadings BeforeWall(double gap, double heading_deg) {
  const BodyFrame self = FrameFacing(-foot_bot::kRadius - gap, 0.0, heading_deg);
  ProximityRing ring(self);
  ring.See(MakeBox({0.1, 0.0}, 0.2, 6.0, 0.0));
  return ReadingsOf(ring);
}

ProximityReadings BeforeRobot(double gap, double heading_deg, double other_heading_deg) {
  const BodyFrame self = FrameFacing(0.0, 0.0, heading_deg);
  ProximityRing ring(self);
  ring.See(FrameFacing(2.0 * foot_bot::kRadius + gap, 0.0, other_heading_deg));
  return ReadingsOf(ring);
}

// An edge: what ARGoS says lies between our readings one step of the sweep nearer and farther.
bool BetweenSteps(double value, double nearer, double farther) {
  return value >= std::min(nearer, farther) - 1e-3 && value <= std::max(nearer, farther) + 1e-3;
}

struct SweepErrors {
  double largest = 0.0;  // away from edges
  int edges = 0;         // readings judged as edges
};

template <typename Sense>
SweepErrors CompareSweep(const std::string& file, const Sense& sense) {
  const CsvTable table = ReadArgosCsv("sensors/" + file);
  SweepErrors errors;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double gap = table.At(row, "gap_m");
    const ProximityReadings ours = sense(table, row, gap);
    const ProximityReadings nearer = sense(table, row, gap - kGapStep);
    const ProximityReadings farther = sense(table, row, gap + kGapStep);
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double argos = table.At(row, "s" + std::to_string(i));
      const double error = std::abs(ours[i] - argos);
      if (error > 1e-3 && BetweenSteps(argos, nearer[i], farther[i])) {
        ++errors.edges;
        std::printf("%s: edge at gap %.4f sensor %zu: ARGoS %.6f ours %.6f\n", file.c_str(), gap, i, argos,
                    ours[i]);
      } else {
        errors.largest = std::max(errors.largest, error);
      }
    }
  }
  std::printf("%s: largest error %.2e of full scale, %d of %zu readings at edges\n", file.c_str(),
              errors.largest, errors.edges, table.rows.size() * 24);
  return errors;
}

TEST(ProximityReading, FollowsTheInfraredModel) {
  EXPECT_EQ(ProximityReading(0.0), 1.0);
  EXPECT_EQ(ProximityReading(0.00988), 1.0);
  EXPECT_NEAR(ProximityReading(0.0989), 0.1015, 1e-4);
  EXPECT_NEAR(ProximityReading(0.0999999), 0.100363, 1e-5);
  EXPECT_EQ(ProximityReading(0.1), 0.0);
}

TEST(ProximityRing, MatchesArgosBeforeAWall) {
  const SweepErrors errors =
      CompareSweep("prox_wall.csv", [](const CsvTable& table, std::size_t row, double gap) {
        return BeforeWall(gap, table.At(row, "heading_deg"));
      });
  EXPECT_LT(errors.largest, 1e-3);
  EXPECT_LE(errors.edges, 4);
}

TEST(ProximityRing, MatchesArgosBeforeARobot) {
  const SweepErrors errors =
      CompareSweep("prox_robot.csv", [](const CsvTable& table, std::size_t row, double gap) {
        return BeforeRobot(gap, table.At(row, "self_heading_deg"), table.At(row, "other_heading_deg"));
      });
  EXPECT_LT(errors.largest, 1e-3);
  EXPECT_LE(errors.edges, 4);
}

TEST(ProximityRing, SeesNothingInTheOpen) {
  const BodyFrame self = FrameFacing(0.0, 0.0, 30.0);
  ProximityRing ring(self);
  ring.See(MakeBox({0.5, 0.0}, 0.2, 6.0, 0.0));
  ring.See(FrameFacing(0.0, 0.29, 0.0));
  EXPECT_EQ(ring.hits(), 0u);
  EXPECT_THAT(ReadingsOf(ring), Each(0.0));
}

TEST(ProximityRing, ReadsOneWhereABodyIsTouchedOrOverlapped) {
  const BodyFrame self = FrameFacing(0.0, 0.0, -7.5);  // sensor 0 looks along +x
  ProximityRing ring(self);
  ring.See(FrameFacing(2.0 * foot_bot::kRadius - 0.005, 0.0, 0.0));
  EXPECT_NE(ring.hits(), 0u);
  EXPECT_EQ(ReadingsOf(ring)[0], 1.0);
  EXPECT_EQ(ReadingsOf(ring)[12], 0.0);
}

TEST(ProximityRing, SeesTheFrontOfAnotherRobotOneCentimetreEarlier) {
  const BodyFrame self = FrameFacing(0.0, 0.0, -7.5);
  const double distance = 2.0 * foot_bot::kRadius + 0.105;
  ProximityRing facing(self);
  facing.See(FrameFacing(distance, 0.0, 180.0));
  EXPECT_NEAR(ReadingsOf(facing)[0], ProximityReading(0.095), 1e-9);
  ProximityRing averted(self);
  averted.See(FrameFacing(distance, 0.0, 0.0));
  EXPECT_EQ(averted.hits(), 0u);
}

// The ring culls and shares work between rays; the plain ray cast of each sensor is its oracle.
RC_GTEST_PROP(ProximityRing, AgreesWithPlainRays, ()) {
  const auto number = [](int low, int high, double unit) { return *rc::gen::inRange(low, high + 1) * unit; };
  const BodyFrame self =
      FrameFacing(number(-100, 100, 1e-3), number(-100, 100, 1e-3), number(-1800, 1800, 0.1));
  const OrientedBox box = MakeBox({number(-400, 400, 1e-3), number(-400, 400, 1e-3)}, number(1, 500, 1e-3),
                                  number(1, 500, 1e-3), number(-314, 314, 0.01));
  const BodyFrame robot =
      FrameFacing(number(-300, 300, 1e-3), number(-300, 300, 1e-3), number(-1800, 1800, 0.1));
  ProximityRing ring(self);
  ring.See(box);
  ring.See(robot);
  const ProximityReadings readings = ReadingsOf(ring);
  for (int i = 0; i < foot_bot::kProximitySensors; ++i) {
    const Vec2 ray = UnitVector(self.heading + ProximityBearing(i));
    const Vec2 origin = self.position + foot_bot::kRadius * ray;
    const Vec2 gripper = robot.position + foot_bot::kRadius * robot.direction;
    double expected = 0.0;
    double tolerance = 1e-9;
    for (const double distance :
         {RayHit(box, origin, ray, foot_bot::kProximityRange),
          RayHit(robot.position, foot_bot::kRadius, origin, ray, foot_bot::kProximityRange),
          RayHit(gripper, foot_bot::kGripperRadius, origin, ray, foot_bot::kProximityRange)}) {
      if (distance != kNoHit) expected = std::max(expected, ProximityReading(distance));
      if (std::abs(distance - 0.009889556) < 1e-9) tolerance = 1e-3;  // the model's jump to 1
    }
    RC_ASSERT(std::abs(readings[static_cast<std::size_t>(i)] - expected) <= tolerance);
  }
}

}  // namespace
}  // namespace gauntlet::sim
