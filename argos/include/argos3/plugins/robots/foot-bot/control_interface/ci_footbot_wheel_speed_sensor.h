// How the wheels turn, under the name that sources of before 2015 use.
#pragma once

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_FootBotWheelSpeedSensor : public CCI_Sensor {
 public:
  struct SReading {
    Real LinearVelocityLeft = 0.0;   // cm/s
    Real LinearVelocityRight = 0.0;  // cm/s
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos
