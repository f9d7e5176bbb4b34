// A step of a controller that was written for ARGoS allocates nothing of ours. An executable of its own,
// because it replaces operator new.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "argos/controller_adapter.h"
#include "sim/simulation.h"
#include "tests/support/sanitizer.h"
#include "tests/support/toy_scenario.h"

#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

namespace {
long allocations = 0;
}

#if !GAUNTLET_SANITIZED
void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
#endif

// Uses every sensor, talks, blinks and drives about.
class CBusy : public argos::CCI_Controller {
 public:
  void Init(argos::TConfigurationNode& /*parameters*/) override {
    for (const auto& [tag, sensor] : GetAllSensors()) GetSensor<argos::CCI_Sensor>(tag)->Enable();
    wheels_ = GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering");
    ears_ = GetSensor<argos::CCI_RangeAndBearingSensor>("range_and_bearing");
    leds_ = GetActuator<argos::CCI_LEDsActuator>("leds");
    radio_ = GetActuator<argos::CCI_RangeAndBearingActuator>("range_and_bearing");
    GetActuator<argos::CCI_FootBotDistanceScannerActuator>("footbot_distance_scanner")->SetRPM(30.0);
  }
  void ControlStep() override {
    const auto& packets = ears_->GetReadings();
    ++ticks_;
    heard += packets.size();
    leds_->SetAllColors(ticks_ % 3 == 0 ? argos::CColor::BLACK : argos::CColor::GREEN);
    radio_->SetData(0, static_cast<argos::UInt8>(ticks_));
    wheels_->SetLinearVelocity(packets.size() % 2 == 0 ? 10.0 : 4.0, 8.0);
  }

  inline static std::size_t heard = 0;

 private:
  argos::CCI_DifferentialSteeringActuator* wheels_ = nullptr;
  argos::CCI_RangeAndBearingSensor* ears_ = nullptr;
  argos::CCI_LEDsActuator* leds_ = nullptr;
  argos::CCI_RangeAndBearingActuator* radio_ = nullptr;
  int ticks_ = 0;
};

REGISTER_CONTROLLER(CBusy, "busy")

namespace gauntlet::argos_form {
namespace {

// The first ones may: the scanner begins to turn.
constexpr sim::Tick kGrowingTicks = 5;

TEST(Adapter, AllocatesNothingAfterTheFirstTicks) {
  if (testing_support::kSanitized) GTEST_SKIP() << "sanitizers bring their own operator new";
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::vector<sim::ToyRobot> robots =
      sim::RandomRobots(8, sim::TestCase{}, sim::Vec2::Zero(), 1.0, {}, random);
  long late = 0;
  for (sim::ToyRobot& robot : robots) {
    auto adapter = std::make_shared<ControllerAdapter>(ControllerSection{.label = "busy"},
                                                       ControllerAdapter::Robot{.start = robot.pose});
    robot.devices = adapter->Devices();
    robot.behaviour = [adapter, &late](const sim::ControlStep& step) {
      const long before = allocations;
      adapter->Step(step);
      if (step.tick > kGrowingTicks) late += allocations - before;
    };
  }
  sim::ToyScenario scenario(sim::TestCase{}, robots, 600);
  const long before = allocations;
  EXPECT_EQ(Simulate(scenario, 1, false).verdict, sim::Verdict::kCompleted);
  EXPECT_GT(allocations, before) << "the counter does not count";
  EXPECT_GT(CBusy::heard, 0u);
  EXPECT_EQ(late, 0);
}

}  // namespace
}  // namespace gauntlet::argos_form
