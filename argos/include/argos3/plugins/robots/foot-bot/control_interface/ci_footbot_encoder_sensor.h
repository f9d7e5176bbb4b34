// How far the wheels have turned; there is none on the robots of Gauntlet, nor on those that ARGoS simulates.
#pragma once

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_FootBotEncoderSensor : public CCI_Sensor {
 public:
  struct SReading {
    Real CoveredDistanceLeftWheel = 0.0;   // cm
    Real CoveredDistanceRightWheel = 0.0;  // cm
    Real WheelAxisLength = 14.0;           // cm
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos
