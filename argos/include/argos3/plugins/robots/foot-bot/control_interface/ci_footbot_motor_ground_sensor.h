// The floor below the wheels, in 4 places.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CCI_FootBotMotorGroundSensor : public CCI_Sensor {
 public:
  struct SReading {
    Real Value = 0.0;  // 0 black to 1 white
    CVector2 Offset;   // cm from the robot's centre: x ahead, y left

    SReading() = default;
    SReading(Real value, const CVector2& offset) : Value(value), Offset(offset) {}
  };
  using TReadings = std::vector<SReading>;

  CCI_FootBotMotorGroundSensor() {
    for (const CVector2& offset :
         {CVector2{6.3, 1.16}, CVector2{-6.3, 1.16}, CVector2{-6.3, -1.16}, CVector2{6.3, -1.16}}) {
      m_tReadings.emplace_back(0.0, offset);
    }
  }

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace argos
