// Covers: argos/actuators.cc, argos/ci_controller.cc, argos/mailbox.cc, argos/palette.cc, argos/sensors.cc,
// argos/simulator.cc
#include "argos/controller_adapter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "sim/simulation.h"
#include "tests/support/paths.h"
#include "tests/support/toy_scenario.h"

#include <argos3/core/simulator/simulator.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/math/rng.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_gripper_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_motor_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_encoder_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_gripper_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

// Does in Init and ControlStep what the test says.
class CScripted : public argos::CCI_Controller {
 public:
  inline static std::function<void(CScripted&, argos::TConfigurationNode&)> init;
  inline static std::function<void(CScripted&)> step;
  inline static std::vector<std::string> calls;

  void Init(argos::TConfigurationNode& parameters) override {
    calls.push_back("Init " + GetId());
    if (init) init(*this, parameters);
  }
  void ControlStep() override {
    calls.push_back("ControlStep " + GetId());
    if (step) step(*this);
  }
  void Destroy() override { calls.push_back("Destroy " + GetId()); }
};

REGISTER_CONTROLLER(CScripted, "scripted")

namespace gauntlet::argos_form {
namespace {

using testing::ElementsAre;

class Adapter : public testing::Test {
 protected:
  void SetUp() override {
    CScripted::init = nullptr;
    CScripted::step = nullptr;
    CScripted::calls.clear();
  }

  // Runs scripted controllers from these places.
  sim::RunResult Run(const std::vector<sim::Pose>& starts, sim::Tick ticks, std::uint64_t seed = 7) {
    std::vector<std::shared_ptr<ControllerAdapter>> adapters;
    std::vector<sim::ToyRobot> robots;
    for (const sim::Pose& start : starts) {
      const auto number = static_cast<sim::RobotIndex>(robots.size());
      auto adapter = std::make_shared<ControllerAdapter>(
          section, ControllerAdapter::Robot{.number = number, .seed = seed, .start = start});
      adapters.push_back(adapter);
      robots.push_back({.pose = start,
                        .behaviour = [adapter](const sim::ControlStep& step) { adapter->Step(step); },
                        .devices = adapter->Devices(),
                        .beacon = sim::Color::kBlack,
                        .beginning = [adapter](sim::Actuators& actuators) { adapter->Begin(actuators); }});
    }
    sim::ToyScenario scenario(sim::TestCase{}, robots, ticks);
    scenario.floor = [](const sim::Vec2& point) { return point.x() < 0.0 ? 0.25 : 1.0; };
    return Simulate(scenario, seed, true);
  }

  ControllerSection section = {.label = "scripted"};
};

TEST_F(Adapter, KeepsTheLifeCycleOfArgos) {
  Run({{{0, 0}, 0}, {{1, 0}, 0}}, 2);
  EXPECT_THAT(CScripted::calls,
              ElementsAre("Init fb0", "Init fb1", "ControlStep fb0", "ControlStep fb1", "ControlStep fb0",
                          "ControlStep fb1", "Destroy fb0", "Destroy fb1"));
}

TEST_F(Adapter, GivesReadingsInTheUnitsOfArgos) {
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetSensor<argos::CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera")
        ->Enable();
    robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing");
    robot.GetSensor<argos::CCI_FootBotMotorGroundSensor>("footbot_motor_ground");
    robot.GetSensor<argos::CCI_GroundSensor>("ground");
    robot.GetActuator<argos::CCI_LEDsActuator>("leds")->SetSingleColor(12, argos::CColor(10, 20, 30));
    auto* const radio = robot.GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing");
    radio->SetData(0, 42);
    auto* const place = robot.GetSensor<argos::CCI_PositioningSensor>("positioning");
    const double y = robot.GetId() == "fb1" ? 0.3 : 0.0;
    EXPECT_EQ(place->GetReading().Position, argos::CVector3(-0.5, y, 0.0));
  };
  int looked = 0;
  CScripted::step = [&](CScripted& robot) {
    auto& space = argos::CSimulator::GetInstance().GetSpace();
    if (robot.GetId() != "fb0" || space.GetSimulationClock() != 3) return;
    ++looked;
    const auto& blobs = robot
                            .GetSensor<argos::CCI_ColoredBlobOmnidirectionalCameraSensor>(
                                "colored_blob_omnidirectional_camera")
                            ->GetReadings();
    ASSERT_EQ(blobs.BlobList.size(), 1u);
    EXPECT_EQ(blobs.Counter, 3u);
    EXPECT_EQ(blobs.BlobList[0]->Color, argos::CColor(10, 20, 30));
    EXPECT_NEAR(blobs.BlobList[0]->Distance, 30.0, 1e-9);
    EXPECT_NEAR(blobs.BlobList[0]->Angle.GetValue(), sim::kPi / 2, 1e-9);
    EXPECT_TRUE(blobs.BlobList[0]->Angle.HasSine());
    EXPECT_EQ(Sin(blobs.BlobList[0]->Angle), Sin(argos::CRadians(blobs.BlobList[0]->Angle)));
    const auto& packets =
        robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing")->GetReadings();
    ASSERT_EQ(packets.size(), 1u);
    EXPECT_NEAR(packets[0].Range, 30.0, 1e-9);
    EXPECT_NEAR(packets[0].HorizontalBearing.GetValue(), sim::kPi / 2, 1e-9);
    EXPECT_TRUE(packets[0].HorizontalBearing.HasSine());
    EXPECT_EQ(packets[0].Data[0], 42);
    EXPECT_EQ(packets[0].Data.Size(), 10u);
    const auto& ground =
        robot.GetSensor<argos::CCI_FootBotMotorGroundSensor>("footbot_motor_ground")->GetReadings();
    EXPECT_EQ(ground[1].Value, 0.25);
    EXPECT_EQ(ground[1].Offset, argos::CVector2(-6.3, 1.16));
    EXPECT_THAT(robot.GetSensor<argos::CCI_GroundSensor>("ground")->GetReadings(),
                ElementsAre(0.25, 0.25, 0.25, 0.25, 0, 0, 0, 0, 0, 0, 0, 0));
  };
  Run({{{-0.5, 0}, 0}, {{-0.5, 0.3}, 0}}, 3);
  EXPECT_EQ(looked, 1);
}

// More bytes than a simulated message has: what a robot hears is what the other one said in the tick before,
// whichever of them steps first.
TEST_F(Adapter, SendsMessagesOfTheSizeThatTheFileSays) {
  section.message_bytes = 24;
  section.robots = "f-";
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing");
    EXPECT_EQ(robot.GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing")->GetSize(), 24u);
  };
  std::vector<std::string> heard;
  CScripted::step = [&](CScripted& robot) {
    const auto tick = argos::CSimulator::GetInstance().GetSpace().GetSimulationClock();
    for (const auto& packet :
         robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing")->GetReadings()) {
      ASSERT_EQ(packet.Data.Size(), 24u);
      heard.push_back(robot.GetId() + " " + std::to_string(packet.Data[0]) + " " +
                      std::to_string(packet.Data[23]));
    }
    auto* const radio = robot.GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing");
    radio->SetData(0, static_cast<argos::UInt8>(tick));
    radio->SetData(23, robot.GetId() == "f-0" ? 100 : 200);
  };
  Run({{{-0.5, 0}, 0}, {{-0.5, 0.3}, 0}}, 4);
  EXPECT_THAT(heard, ElementsAre("f-0 0 0", "f-1 0 0", "f-0 1 200", "f-1 1 100", "f-0 2 200", "f-1 2 100",
                                 "f-0 3 200", "f-1 3 100"));
}

TEST_F(Adapter, HearsAsManyBytesAsAShortMessageHas) {
  section.message_bytes = 4;
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing");
    robot.GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing")->SetData(3, 7);
  };
  int looked = 0;
  CScripted::step = [&](CScripted& robot) {
    for (const auto& packet :
         robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing")->GetReadings()) {
      EXPECT_EQ(packet.Data.Size(), 4u);
      looked += packet.Data[3] == 7;
    }
  };
  Run({{{-0.5, 0}, 0}, {{-0.5, 0.3}, 0}}, 2);
  EXPECT_EQ(looked, 4);
}

// ARGoS lets actuators act at the beginning of a tick, also of the first.
TEST_F(Adapter, ActsInTheFirstTickOnWhatInitHasCommanded) {
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetSensor<argos::CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera")
        ->Enable();
    robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing");
    robot.GetSensor<argos::CCI_PositioningSensor>("positioning");
    robot.GetActuator<argos::CCI_LEDsActuator>("leds")->SetSingleColor(12, argos::CColor::RED);
    robot.GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing")->SetData(0, 42);
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering")
        ->SetLinearVelocity(10.0, 10.0);
  };
  int looked = 0;
  CScripted::step = [&](CScripted& robot) {
    if (robot.GetId() != "fb0") return;
    ++looked;
    const auto& packets =
        robot.GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing")->GetReadings();
    ASSERT_EQ(packets.size(), 1u);
    EXPECT_EQ(packets[0].Data[0], 42);
    EXPECT_EQ(robot
                  .GetSensor<argos::CCI_ColoredBlobOmnidirectionalCameraSensor>(
                      "colored_blob_omnidirectional_camera")
                  ->GetReadings()
                  .BlobList.size(),
              1u);
    EXPECT_GT(robot.GetSensor<argos::CCI_PositioningSensor>("positioning")->GetReading().Position.GetX(),
              -0.495);
  };
  Run({{{-0.5, 0}, 0}, {{-0.5, 0.3}, 0}}, 1);
  EXPECT_EQ(looked, 1);
}

TEST_F(Adapter, DrivesInCentimetresAndTellsWhatTheWheelsDo) {
  std::vector<double> speeds;
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering")
        ->SetLinearVelocity(5.0, 10.0);
    robot.GetSensor<argos::CCI_DifferentialSteeringSensor>("differential_steering");
  };
  CScripted::step = [&](CScripted& robot) {
    const auto& reading =
        robot.GetSensor<argos::CCI_DifferentialSteeringSensor>("differential_steering")->GetReading();
    speeds.push_back(reading.VelocityRightWheel);
    EXPECT_EQ(reading.CoveredDistanceLeftWheel, reading.VelocityLeftWheel * 0.1);
    EXPECT_EQ(reading.WheelAxisLength, 14.0);
  };
  const sim::RunResult result = Run({{{0, 0}, 0}}, 10);
  ASSERT_EQ(speeds.size(), 10u);
  EXPECT_EQ(speeds[0], 10.0);
  EXPECT_NEAR(result.robots[0].path_length, 0.075, 0.002);
}

TEST_F(Adapter, HasTheDevicesThatInitAsksFor) {
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetSensor<argos::CCI_FootBotProximitySensor>("footbot_proximity");
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering");
  };
  EXPECT_EQ(ControllerAdapter(section, {}).Devices(), sim::Device::kProximity | sim::Device::kWheels);
}

TEST_F(Adapter, HasNoDeviceThatIsAskedForAfterInit) {
  CScripted::step = [](CScripted& robot) {
    EXPECT_FALSE(robot.HasSensor("positioning"));
    EXPECT_THROW(robot.GetSensor<argos::CCI_PositioningSensor>("positioning"), argos::CARGoSException);
  };
  Run({{{0, 0}, 0}}, 2);
  EXPECT_EQ(CScripted::calls.size(), 4u);
}

TEST_F(Adapter, HasTheDevicesOfTheFile) {
  section.devices = {.actuators = {"leds"}, .sensors = {"footbot_proximity"}};
  EXPECT_EQ(ControllerAdapter(section, {}).Devices(), sim::Device::kProximity | sim::Device::kLeds);
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    EXPECT_FALSE(robot.HasSensor("positioning"));
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering");
  };
  EXPECT_THROW(ControllerAdapter(section, {}), argos::CARGoSException);
  section.devices->sensors = {"eyebot_camera"};
  EXPECT_THROW(ControllerAdapter(section, {}), argos::CARGoSException);
}

TEST_F(Adapter, LooksThroughAnEnabledCameraOnly) {
  argos::CCI_Sensor* camera = nullptr;
  CScripted::init = [&](CScripted& robot, argos::TConfigurationNode&) {
    camera = robot.GetSensor<argos::CCI_Sensor>("colored_blob_omnidirectional_camera");
  };
  const ControllerAdapter adapter(section, {});
  EXPECT_FALSE(adapter.Attention(false).Has(sim::Device::kOmnidirectionalCamera));
  camera->Enable();
  EXPECT_TRUE(adapter.Attention(false).Has(sim::Device::kOmnidirectionalCamera));
}

TEST_F(Adapter, SeedsRandomNumbersByTheRunInTheOrderOfRobots) {
  std::vector<argos::UInt32> seeds;
  CScripted::init = [&](CScripted&, argos::TConfigurationNode&) {
    seeds.push_back(argos::CRandom::CreateRNG("argos")->GetSeed());
  };
  // The first generator of seed 124 is ARGoS' own.
  for (int run = 0; run < 2; ++run) {
    seeds.clear();
    Run({{{0, 0}, 0}, {{1, 0}, 0}}, 1, 124);
    EXPECT_THAT(seeds, ElementsAre(2996933276u, 3201775633u));
  }
}

TEST_F(Adapter, TurnsTheScannerAndTheTurret) {
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_FootBotDistanceScannerActuator>("footbot_distance_scanner")
        ->SetAngle(argos::CRadians::ZERO);
    robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
    robot.GetActuator<argos::CCI_FootBotTurretActuator>("footbot_turret")
        ->SetActiveWithRotation(argos::CRadians(0.5));
    robot.GetSensor<argos::CCI_FootBotTurretEncoderSensor>("footbot_turret_encoder");
  };
  std::size_t rays = 0;
  double rotation = 0.0;
  double nearest = 0.0;
  CScripted::step = [&](CScripted& robot) {
    auto* const scanner =
        robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
    rays = scanner->GetReadingsMap().size();
    if (rays > 0) nearest = scanner->GetShortReadingsMap().at(argos::CRadians::ZERO);
    rotation = robot.GetSensor<argos::CCI_FootBotTurretEncoderSensor>("footbot_turret_encoder")
                   ->GetRotation()
                   .GetValue();
  };
  Run({{{2.75, 0}, 0}}, 3);
  EXPECT_EQ(rays, 4u);
  EXPECT_NEAR(nearest, 100.0 * (2.95 - 2.75 - sim::foot_bot::kRadius), 1e-6);
  EXPECT_EQ(rotation, 0.5);
}

// Against what ARGoS had: controllers keep maps by angle, which must not grow.
TEST_F(Adapter, TheScannersAnglesAreThoseOfArgosToTheLastBit) {
  constexpr sim::Tick kTicks = 1000;
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_FootBotDistanceScannerActuator>("footbot_distance_scanner")->SetRPM(30.0);
    robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
  };
  std::set<double> angles;
  std::ostringstream seen;
  seen.precision(17);
  int tick = 0;
  CScripted::step = [&](CScripted& robot) {
    auto* const scanner =
        robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
    ++tick;
    for (const auto& [angle, distance] : scanner->GetReadingsMap()) angles.insert(angle.GetValue());
    if (tick > 3 && tick < 998) return;
    for (const auto& [angle, distance] : scanner->GetShortReadingsMap())
      seen << tick << ",short," << angle.GetValue() << "\n";
    for (const auto& [angle, distance] : scanner->GetLongReadingsMap())
      seen << tick << ",long," << angle.GetValue() << "\n";
  };
  Run({{{0, 0}, 0}}, kTicks);
  EXPECT_EQ(angles.size(), 120u);
  std::ifstream file(GAUNTLET_SOURCE_DIR "/tests/argos/scanner_angles.csv");
  const std::string recorded(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(recorded.substr(recorded.find("angle\n") + 6), seen.str());
}

// Speeds come from what it draws, from the bytes of a char and a flag, and from how many angles its scanner
// has had: each of these was different once. The trajectory was recorded in ARGoS.
TEST_F(Adapter, ARobotGoesAsInArgosWhatItDrawsAndScans) {
  struct Prober {
    argos::CRandom::CRNG* random = nullptr;
    std::set<double> angles;
  };
  std::map<std::string, Prober> probers;
  CScripted::init = [&](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_FootBotDistanceScannerActuator>("footbot_distance_scanner")->SetRPM(30.0);
    robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering");
    probers[robot.GetId()].random = argos::CRandom::CreateRNG("argos");
  };
  CScripted::step = [&](CScripted& robot) {
    Prober& prober = probers.at(robot.GetId());
    for (const auto& [angle, distance] :
         robot.GetSensor<argos::CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner")
             ->GetReadingsMap())
      prober.angles.insert(angle.GetValue());
    argos::CByteArray bytes;
    bytes << 'x' << true;
    const double left = prober.random->Uniform(argos::CRange<argos::Real>(0.0, 10.0));
    const double right = prober.random->Uniform(argos::CRange<argos::Real>(0.0, 10.0));
    const double faster = static_cast<double>(bytes.Size()) / 8.0 * 120.0 /
                          static_cast<double>(std::max<std::size_t>(prober.angles.size(), 120));
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering")
        ->SetLinearVelocity(left * faster, right * faster);
  };
  const sim::RunResult ours = Run({{{0, 0}, 0}, {{0, 1.5}, sim::kPi / 2.0}}, 400, /*seed=*/7);
  std::ifstream file(GAUNTLET_SOURCE_DIR "/tests/argos/prober_trajectory.csv");
  std::size_t compared = 0;
  for (std::string line; std::getline(file, line);) {
    double time = 0.0;
    std::size_t robot = 0;
    double x = 0.0;
    double y = 0.0;
    if (std::sscanf(line.c_str(), "%lf,fb%zu,foot-bot,%lf,%lf", &time, &robot, &x, &y) != 4) continue;
    const sim::RobotState& state = ours.trajectory.at(static_cast<std::size_t>(time * 10.0)).at(robot);
    EXPECT_NEAR(state.x, x, 1e-6) << line;
    EXPECT_NEAR(state.y, y, 1e-6) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 10u);
}

TEST_F(Adapter, FasterWheelsThanThereAreKeepToThePath) {
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering")
        ->SetLinearVelocity(200.0, 300.0);
  };
  CScripted::step = nullptr;
  const sim::RunResult fast = Run({{{0, 0}, 0}}, 5);
  EXPECT_EQ(fast.verdict, sim::Verdict::kCompleted) << fast.message;
  CScripted::init = [](CScripted& robot, argos::TConfigurationNode&) {
    robot.GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering")
        ->SetLinearVelocity(200.0 / 3.0, 100.0);
  };
  const sim::RunResult slow = Run({{{0, 0}, 0}}, 5);
  EXPECT_NEAR(fast.robots[0].end.position.x(), slow.robots[0].end.position.x(), 1e-12);
  EXPECT_NEAR(fast.robots[0].end.heading, slow.robots[0].end.heading, 1e-12);
}

TEST_F(Adapter, ClosesTheGripperBeyondHalfOfItsAperture) {
  argos::CCI_FootBotGripperActuator* gripper = nullptr;
  CScripted::init = [&](CScripted& robot, argos::TConfigurationNode&) {
    gripper = robot.GetActuator<argos::CCI_FootBotGripperActuator>("footbot_gripper");
  };
  ControllerAdapter adapter(section, {});
  sim::SensorReadings readings;
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const auto closed = [&](double aperture) {
    gripper->SetAperture(argos::CRadians(aperture));
    adapter.Step({.tick = 1, .readings = readings, .actuators = actuators, .random = random});
    return actuators.gripper_closed;
  };
  EXPECT_FALSE(closed(0.7));
  EXPECT_TRUE(closed(-0.8));
  EXPECT_TRUE(closed(1.5));
}

TEST_F(Adapter, LocksTheSimpleGripper) {
  argos::CCI_GripperActuator* gripper = nullptr;
  CScripted::init = [&](CScripted& robot, argos::TConfigurationNode&) {
    gripper = robot.GetActuator<argos::CCI_GripperActuator>("gripper");
  };
  ControllerAdapter adapter(section, {});
  EXPECT_EQ(adapter.Devices(), sim::Device::kGripper);
  sim::SensorReadings readings;
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (const bool locked : {true, false}) {
    locked ? gripper->Lock() : gripper->Unlock();
    adapter.Step({.tick = 1, .readings = readings, .actuators = actuators, .random = random});
    EXPECT_EQ(actuators.gripper_closed, locked);
  }
}

TEST_F(Adapter, RefusesAControllerThatNobodyRegistered) {
  section.label = "unheard_of";
  EXPECT_THROW(ControllerAdapter(section, {}), argos::CARGoSException);
}

TEST(Palette, KeepsAtMost256Colors) {
  Palette palette;
  EXPECT_EQ(palette.NumberOf(argos::CColor::RED), sim::Color::kRed);
  for (int i = 0; i < 247; ++i) palette.NumberOf(argos::CColor(1, 2, static_cast<argos::UInt8>(i)));
  EXPECT_EQ(palette.ColorOf(palette.NumberOf(argos::CColor(1, 2, 200))), argos::CColor(1, 2, 200));
  EXPECT_THROW(palette.NumberOf(argos::CColor(3, 3, 3)), argos::CARGoSException);
}

}  // namespace
}  // namespace gauntlet::argos_form
