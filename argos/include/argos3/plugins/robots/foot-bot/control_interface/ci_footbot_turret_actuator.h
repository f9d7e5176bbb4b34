// The turret. In Gauntlet it carries neither LEDs nor gripper: only its encoder shows how it turns.
#pragma once

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

class CCI_FootBotTurretActuator : public CCI_Actuator {
 public:
  static constexpr CRange<SInt32> SPEED_RANGE{-4, 4};
  static constexpr CRange<Real> NORMALIZED_SPEED_RANGE{-1.0, 1.0};

  enum ETurretModes { MODE_OFF, MODE_PASSIVE, MODE_SPEED_CONTROL, MODE_POSITION_CONTROL };

  virtual void SetRotation(const CRadians& rotation) { m_cRotation = rotation; }
  virtual void SetRotationSpeed(SInt32 speed) { m_nSpeed = speed; }  // turns per minute
  virtual void SetMode(ETurretModes mode) { m_eMode = mode; }
  virtual void SetActiveWithRotation(const CRadians& rotation) {
    SetPositionControlMode();
    SetRotation(rotation);
  }
  virtual void SetPositionControlMode() { SetMode(MODE_POSITION_CONTROL); }
  virtual void SetSpeedControlMode() { SetMode(MODE_SPEED_CONTROL); }
  virtual void SetPassiveMode() { SetMode(MODE_PASSIVE); }
  void Reset() override {
    m_eMode = MODE_OFF;
    m_cRotation = CRadians::ZERO;
    m_nSpeed = 0;
  }

 protected:
  ETurretModes m_eMode = MODE_OFF;
  CRadians m_cRotation;
  SInt32 m_nSpeed = 0;
};

}  // namespace argos
