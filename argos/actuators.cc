#include <algorithm>
#include <cmath>

#include "argos/devices.h"

#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_gripper_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_gripper_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>

namespace gauntlet::argos_form {
namespace {

using sim::Device;

constexpr double kMetres = 0.01;                          // in a centimetre
constexpr double kTurnPerMinute = 2.0 * sim::kPi / 60.0;  // rad/s
constexpr std::size_t kBeacon = 12;                       // its number among the LEDs

class Wheels final : public argos::CCI_DifferentialSteeringActuator, public ActuatorLink {
 public:
  void Give(sim::Actuators& actuators) override {
    // ARGoS drives as fast as it is told, the simulator no faster than that: the path stays the same.
    const double fastest =
        std::max(std::abs(m_fCurrentVelocity[0]), std::abs(m_fCurrentVelocity[1])) * kMetres;
    const double slower = std::max(1.0, fastest / sim::foot_bot::kMaxWheelSpeed);
    actuators.left_wheel = m_fCurrentVelocity[0] * kMetres / slower;
    actuators.right_wheel = m_fCurrentVelocity[1] * kMetres / slower;
  }
};

class Leds final : public argos::CCI_LEDsActuator, public ActuatorLink {
 public:
  explicit Leds(RobotParts& parts) : palette_(parts.palette) {}
  void Give(sim::Actuators& actuators) override {
    if (given_ == m_tSettings) return;
    given_ = m_tSettings;
    for (std::size_t i = 0; i < kBeacon; ++i) actuators.ring[i] = palette_.NumberOf(m_tSettings[i]);
    actuators.beacon = palette_.NumberOf(m_tSettings[kBeacon]);
  }

 private:
  Palette& palette_;
  TSettings given_;  // what the robot's actuators have
};

class Radio final : public argos::CCI_RangeAndBearingActuator, public ActuatorLink {
 public:
  explicit Radio(RobotParts& parts) : CCI_RangeAndBearingActuator(parts.message_bytes), parts_(parts) {}
  void Give(sim::Actuators& actuators) override {
    const std::span<const argos::UInt8> bytes(m_cData.ToCArray(), m_cData.Size());
    if (bytes.size() > actuators.message.size()) {
      actuators.message = parts_.mailbox.Put(parts_.robot, bytes);
    } else {
      std::ranges::copy(bytes, actuators.message.begin());
    }
  }

 private:
  const RobotParts& parts_;
};

class Gripper final : public argos::CCI_FootBotGripperActuator, public ActuatorLink {
 public:
  void Give(sim::Actuators& actuators) override {
    actuators.gripper_closed = m_cAperture.GetAbsoluteValue() / (sim::kPi / 2.0) > 0.5;
  }
};

class SimpleGripper final : public argos::CCI_GripperActuator, public ActuatorLink {
 public:
  void Give(sim::Actuators& actuators) override { actuators.gripper_closed = m_fLockState > 0.5; }
};

class Turret final : public argos::CCI_FootBotTurretActuator, public ActuatorLink {
 public:
  explicit Turret(RobotParts& parts) : parts_(parts) {}
  void Give(sim::Actuators& /*actuators*/) override {
    if (m_eMode == MODE_POSITION_CONTROL) parts_.turret = sim::WrapAngle(m_cRotation.GetValue());
    if (m_eMode == MODE_SPEED_CONTROL) {
      parts_.turret = sim::WrapAngle(parts_.turret + m_nSpeed * kTurnPerMinute * sim::kTickSeconds);
    }
  }

 private:
  RobotParts& parts_;
};

class Scanner final : public argos::CCI_FootBotDistanceScannerActuator, public ActuatorLink {
 public:
  explicit Scanner(RobotParts& parts) : parts_(parts) {}
  void Give(sim::Actuators& actuators) override {
    using Mode = sim::ScannerCommand::Mode;
    actuators.scanner = {};
    if (m_eMode == EMode::kAngle) {
      actuators.scanner = {.mode = Mode::kAngle, .value = m_cAngle.GetValue()};
      parts_.scanner = m_cAngle;
      parts_.scanner.UnsignedNormalize();
    }
    if (m_eMode == EMode::kSpeed) {
      const double speed = m_fRPM * kTurnPerMinute;
      actuators.scanner = {.mode = Mode::kSpeed, .value = speed};
      parts_.scanner += argos::CRadians(speed * sim::kTickSeconds);
      parts_.scanner.UnsignedNormalize();
    }
  }

 private:
  RobotParts& parts_;
};

template <typename Actuator>
Linked<argos::CCI_Actuator, ActuatorLink> Make(RobotParts& parts) {
  Actuator* const made = NewDevice<Actuator>(parts);
  return {made, made};
}

}  // namespace

std::span<const ActuatorRow> ActuatorRows() {
  static constexpr ActuatorRow kRows[] = {
      {"differential_steering", Device::kWheels, Make<Wheels>},
      {"footbot_distance_scanner", Device::kDistanceScanner, Make<Scanner>},
      {"footbot_gripper", Device::kGripper, Make<Gripper>},
      {"footbot_turret", {}, Make<Turret>},
      {"gripper", Device::kGripper, Make<SimpleGripper>},
      {"leds", Device::kLeds, Make<Leds>},
      {"range_and_bearing", Device::kRangeAndBearing, Make<Radio>},
  };
  return kRows;
}

}  // namespace gauntlet::argos_form
