// The floor below the robot: of the foot-bot the 4 motor ground sensors, then the 8 base ground sensors.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_GroundSensor : public CCI_Sensor {
 public:
  // 0 black to 1 white; the last 8 are one of both.
  const std::vector<Real>& GetReadings() const { return m_tReadings; }

 protected:
  std::vector<Real> m_tReadings = std::vector<Real>(12, 0.0);
};

}  // namespace argos
