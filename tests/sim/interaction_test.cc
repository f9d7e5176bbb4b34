// What controllers and scenarios do to each other through range-and-bearing, grippers, lamps and the floor.
// Covers: sim/sensors/gripper_sensor.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "sim/simulation.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::sim {
namespace {

using testing::ElementsAre;

ToyRobot RobotAt(double x, double y, DeviceSet devices, Behaviour behaviour) {
  return {.pose = {{x, y}, 0.0}, .behaviour = std::move(behaviour), .devices = devices};
}

TEST(Interaction, MessagesOfATickAreHeardInTheNext) {
  std::vector<int> heard;
  const Behaviour speak = [](const ControlStep& step) {
    step.actuators.message[9] = static_cast<std::uint8_t>(step.tick);
  };
  const Behaviour listen = [&heard](const ControlStep& step) {
    ASSERT_EQ(step.readings.range_and_bearing.size(), 1u);
    heard.push_back(step.readings.range_and_bearing[0].payload[9]);
  };
  ToyScenario scenario(
      TestCase{},
      {RobotAt(0, 0, Device::kRangeAndBearing, speak), RobotAt(1, 0, Device::kRangeAndBearing, listen),
       RobotAt(0, 1, Device::kWheels, speak)},
      4);
  Simulate(scenario, 1, false);
  EXPECT_THAT(heard, ElementsAre(0, 1, 2, 3));
}

TEST(Interaction, ItemsGoFromHandToHand) {
  std::vector<bool> giver_held;
  std::vector<bool> taker_held;
  const Behaviour give = [&giver_held](const ControlStep& step) {
    giver_held.push_back(step.readings.holding_item);
    step.actuators.gripper_closed = step.tick < 3;
  };
  const Behaviour take = [&taker_held](const ControlStep& step) {
    taker_held.push_back(step.readings.holding_item);
  };
  ToyScenario scenario(TestCase{},
                       {RobotAt(0, 0, Device::kGripper, give), RobotAt(1, 0, Device::kGripper, take)}, 6);
  scenario.interact = [](const Interaction& now) {
    const Tick tick = now.observer.last_tick();
    EXPECT_EQ(now.grippers.Closed(0), tick == 2 || tick == 3) << "tick " << tick;
    if (tick == 2) now.grippers.Give(0);
    if (tick == 4) now.grippers.HandOver(0, 1);
    if (tick == 6) now.grippers.Take(1);
  };
  Simulate(scenario, 1, false);
  EXPECT_THAT(giver_held, ElementsAre(false, true, true, false, false, false));
  EXPECT_THAT(taker_held, ElementsAre(false, false, false, true, true, false));
}

TEST(Interaction, ScenarioSeesPosesAndSignalsThatAreSensed) {
  const Behaviour shine = [](const ControlStep& step) {
    step.actuators.Drive(0.1, 0.0);
    step.actuators.beacon = step.tick == 1 ? Color::kGreen : Color::kBlack;
  };
  ToyScenario scenario(TestCase{}, {RobotAt(0, 0, Device::kWheels | Device::kLeds, shine)}, 3);
  std::vector<Color> beacons;
  std::vector<double> places;
  scenario.interact = [&](const Interaction& now) {
    beacons.push_back(now.signals[0].beacon);
    places.push_back(now.observer.Latest()[0].x);
  };
  const RunResult result = Simulate(scenario, 1, true);
  EXPECT_THAT(beacons, ElementsAre(Color::kRed, Color::kGreen, Color::kBlack));
  EXPECT_THAT(places,
              ElementsAre(result.trajectory[1][0].x, result.trajectory[2][0].x, result.trajectory[3][0].x));
}

TEST(Interaction, LampsAndRadioBeaconsAreSensedAsTheScenarioLeavesThem) {
  std::vector<std::size_t> blobs;
  std::vector<double> ranges;
  std::vector<double> brightness;
  const DeviceSet devices = Device::kOmnidirectionalCamera | Device::kRangeAndBearing | Device::kLight;
  ToyScenario scenario(TestCase{},
                       {RobotAt(0, 0, devices,
                                [&](const ControlStep& step) {
                                  blobs.push_back(step.readings.blobs.size());
                                  brightness.push_back(step.readings.light[0]);
                                  for (const Message& message : step.readings.range_and_bearing) {
                                    ranges.push_back(message.range);
                                  }
                                })},
                       2);
  scenario.lamps = {{.position = {1.0, 0.0}, .height = 0.174, .color = Color::kGreen},
                    {.position = {1.0, 0.0}, .intensity = 3.0}};
  scenario.radios = {{.position = {2.0, 0.0}, .range = 2.5}};
  scenario.interact = [&scenario](const Interaction& now) {
    if (now.observer.last_tick() < 2) return;
    scenario.lamps[0].color = Color::kBlack;
    scenario.lamps[1].intensity = 0.0;
    scenario.radios[0].position = {0.0, 1.0};
  };
  Simulate(scenario, 1, false);
  EXPECT_THAT(blobs, ElementsAre(1, 0));
  EXPECT_THAT(ranges, ElementsAre(2.0, 1.0));
  EXPECT_NEAR(brightness[0], 0.435018, 1e-6);
  EXPECT_EQ(brightness[1], 0.0);
}

}  // namespace
}  // namespace gauntlet::sim
