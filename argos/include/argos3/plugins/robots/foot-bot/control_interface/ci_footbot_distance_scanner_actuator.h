// How the distance scanner turns. Off, it reads nothing.
#pragma once

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotDistanceScannerActuator : public CCI_Actuator {
 public:
  virtual void SetAngle(const CRadians& angle) {
    m_eMode = EMode::kAngle;
    m_cAngle = angle;
  }
  virtual void SetRPM(Real turns_per_minute) {
    m_eMode = EMode::kSpeed;
    m_fRPM = turns_per_minute;
  }
  virtual void Enable() { m_eMode = EMode::kAngle; }
  virtual void Disable() { m_eMode = EMode::kOff; }
  void Reset() override { *this = CCI_FootBotDistanceScannerActuator(); }

 protected:
  enum class EMode { kOff, kAngle, kSpeed };

  EMode m_eMode = EMode::kOff;
  CRadians m_cAngle;
  Real m_fRPM = 0.0;
};

}  // namespace argos
