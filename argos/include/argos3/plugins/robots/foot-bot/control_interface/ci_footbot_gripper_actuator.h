// The gripper at the front.
#pragma once

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

class CCI_FootBotGripperActuator : public CCI_Actuator {
 public:
  static const CRadians LOCKED_POSITIVE, LOCKED_NEGATIVE, UNLOCKED;

  // Beyond half of a right angle, to either side, it holds what it touches.
  virtual void SetAperture(const CRadians& aperture) {
    m_cAperture = aperture;
    m_cAperture.SignedNormalize();
    CRange<CRadians>(LOCKED_NEGATIVE, LOCKED_POSITIVE).TruncValue(m_cAperture);
  }
  virtual void LockPositive() { SetAperture(LOCKED_POSITIVE); }
  virtual void LockNegative() { SetAperture(LOCKED_NEGATIVE); }
  virtual void Unlock() { SetAperture(UNLOCKED); }
  virtual void EnableCheckForObjectGrippedRoutine() {}
  virtual void DisableCheckForObjectGrippedRoutine() {}
  void Reset() override { Unlock(); }

 protected:
  CRadians m_cAperture;
};

inline constexpr CRadians CCI_FootBotGripperActuator::LOCKED_POSITIVE(ARGOS_PI / 2.0);
inline constexpr CRadians CCI_FootBotGripperActuator::LOCKED_NEGATIVE(-ARGOS_PI / 2.0);
inline constexpr CRadians CCI_FootBotGripperActuator::UNLOCKED(0.0);

}  // namespace argos
