#include "controllers/aggregation/aggregation_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "controllers/aggregation/aggregation_registry.h"
#include "controllers/registry.h"

namespace gauntlet::controllers::aggregation {
namespace {

using sim::Blob;
using sim::Color;

// The shipped controller of this name, and what it does in a tick in which it sees these lights.
class Robot {
 public:
  explicit Robot(const std::string& name, const sim::Parameters& given = {}) {
    const ControllerInfo* row = FindController(name, "");
    controller_ = row->make(*ResolveParameters(row->parameters, given)).create({});
  }
  sim::WheelSpeeds Step(const std::vector<Blob>& blobs) {
    sim::SensorReadings readings;
    readings.blobs = blobs;
    sim::Actuators actuators;
    sim::RandomStream random(1, sim::StreamPurpose::kTest, static_cast<std::uint32_t>(tick_));
    controller_->Step({tick_++, readings, actuators, random});
    return {actuators.left_wheel, actuators.right_wheel};
  }

 private:
  std::unique_ptr<sim::Controller> controller_;
  sim::Tick tick_ = 0;
};

TEST(SeesRobotAhead, WhereTheRayAheadPassesThroughARedBody) {
  const double edge = std::asin(sim::foot_bot::kRadius / 2.0);
  const auto sees = [](double range, double bearing, Color color) {
    return SeesRobotAhead(std::vector<Blob>{Blob::At(range, bearing, color)});
  };
  EXPECT_TRUE(sees(2.0, 0.0, Color::kRed));
  EXPECT_TRUE(sees(2.0, edge - 1e-6, Color::kRed));
  EXPECT_TRUE(sees(2.0, -edge + 1e-6, Color::kRed));
  EXPECT_FALSE(sees(2.0, edge + 1e-6, Color::kRed));
  EXPECT_FALSE(sees(2.0, std::numbers::pi, Color::kRed)) << "behind";
  EXPECT_FALSE(sees(2.0, 0.0, Color::kGreen));
  EXPECT_FALSE(SeesRobotAhead({}));
}

TEST(AggregationController, BacksOnACircleAloneAndTurnsOnTheSpotWhenItSeesSomebody) {
  Robot robot("aggregation-minimal");
  const sim::WheelSpeeds alone = robot.Step({});
  EXPECT_DOUBLE_EQ(alone.left, -0.07);
  EXPECT_DOUBLE_EQ(alone.right, -0.1);
  const sim::WheelSpeeds seeing = robot.Step({Blob::At(3.0, 0.0, Color::kRed)});
  EXPECT_DOUBLE_EQ(seeing.left, 0.1);
  EXPECT_DOUBLE_EQ(seeing.right, -0.1);
}

TEST(CountNeighbours, CountsRobotsWithinTheRange) {
  const std::vector<Blob> blobs = {Blob::At(0.5, 0.1, Color::kRed), Blob::At(2.0, 3.0, Color::kRed),
                                   Blob::At(2.1, 0.0, Color::kRed), Blob::At(0.5, 0.0, Color::kBlue)};
  EXPECT_EQ(CountNeighbours(blobs, 2.0), 2);
}

// Ticks out of 20,000 in which a robot among `neighbours` walks.
int TicksWalking(int neighbours) {
  Robot robot("aggregation-minimal-improved", {{"walk_time", 0.1}});
  const std::vector<Blob> blobs(static_cast<std::size_t>(neighbours), Blob::At(1.0, 0.0, Color::kRed));
  int walking = 0;
  for (int i = 0; i < 20'000; ++i) walking += robot.Step(blobs).right != -0.1 ? 1 : 0;
  return walking;
}

TEST(AggregationControllerImproved, LeavesWhereFewerThanTheQuorumAreNear) {
  // 0.01 per second: 20 of 20,000 ticks, standard deviation 4.5.
  EXPECT_NEAR(TicksWalking(0), 20, 18);
  EXPECT_NEAR(TicksWalking(9), 20, 18);
  EXPECT_EQ(TicksWalking(10), 0);
}

}  // namespace
}  // namespace gauntlet::controllers::aggregation
