// The battery, which never empties.
#pragma once

#include <limits>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_BatterySensor : public CCI_Sensor {
 public:
  struct SReading {
    Real AvailableCharge = 1.0;                             // 0 to 1
    Real TimeLeft = std::numeric_limits<Real>::infinity();  // s
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos
