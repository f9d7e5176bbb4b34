// The wheels.
#pragma once

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/general.h>

namespace argos {

class CCI_DifferentialSteeringActuator : public CCI_Actuator {
 public:
  // cm/s of the rims, forward positive; holds until changed.
  virtual void SetLinearVelocity(Real left, Real right) {
    m_fCurrentVelocity[0] = left;
    m_fCurrentVelocity[1] = right;
  }
  void Reset() override { SetLinearVelocity(0.0, 0.0); }

 protected:
  Real m_fCurrentVelocity[2] = {0.0, 0.0};
};

}  // namespace argos
