// How the wheels turn.
#pragma once

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/general.h>

namespace argos {

class CCI_DifferentialSteeringSensor : public CCI_Sensor {
 public:
  // As commanded, also of a robot that is blocked.
  struct SReading {
    Real VelocityLeftWheel = 0.0;          // cm/s
    Real VelocityRightWheel = 0.0;         // cm/s
    Real CoveredDistanceLeftWheel = 0.0;   // cm, in the last tick
    Real CoveredDistanceRightWheel = 0.0;  // cm, in the last tick
    Real WheelAxisLength = 14.0;           // cm
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos
