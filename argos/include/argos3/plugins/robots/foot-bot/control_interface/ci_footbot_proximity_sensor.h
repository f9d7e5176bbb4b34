// Bodies within 0.1 m of the robot, in 24 directions.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/bearing.h>

namespace argos {

class CCI_FootBotProximitySensor : public CCI_Sensor {
 public:
  struct SReading {
    Real Value = 0.0;  // 0, nothing to 1, touching
    CBearing Angle;    // from the heading

    SReading() = default;
    SReading(Real value, const CRadians& angle) : Value(value), Angle(angle) {}
  };
  using TReadings = std::vector<SReading>;

  // Reading i at 7.5 + 15 i degrees, in (-180, 180].
  CCI_FootBotProximitySensor() {
    for (int i = 0; i < 24; ++i) {
      m_tReadings.emplace_back(0.0, CRadians((i + 0.5) * ARGOS_PI / 12.0).SignedNormalize());
    }
  }

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace argos
