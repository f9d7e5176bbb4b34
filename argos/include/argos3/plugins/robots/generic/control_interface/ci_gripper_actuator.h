// A gripper that is open or closed.
#pragma once

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_GripperActuator : public CCI_Actuator {
 public:
  // 0 unlocked to 1 locked; beyond a half it holds what it touches.
  void SetLockState(Real state) { m_fLockState = state; }
  void Lock() { SetLockState(1.0); }
  void Unlock() { SetLockState(0.0); }
  void Reset() override { Unlock(); }

 protected:
  Real m_fLockState = 0.0;
};

}  // namespace argos
