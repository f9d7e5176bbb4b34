// Where the robot is.
#pragma once

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CCI_PositioningSensor : public CCI_Sensor {
 public:
  struct SReading {
    CVector3 Position;        // m, in the world
    CQuaternion Orientation;  // its z angle is the heading
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos
