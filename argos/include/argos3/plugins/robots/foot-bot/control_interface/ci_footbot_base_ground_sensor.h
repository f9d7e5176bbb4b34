// The floor below the rim, in 8 places: black or white.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CCI_FootBotBaseGroundSensor : public CCI_Sensor {
 public:
  struct SReading {
    Real Value = 0.0;  // 0 black to 1 white
    CVector2 Offset;   // cm from the robot's centre: x ahead, y left

    SReading() = default;
    SReading(Real value, const CVector2& offset) : Value(value), Offset(offset) {}
  };
  using TReadings = std::vector<SReading>;

  CCI_FootBotBaseGroundSensor() {
    for (const CVector2& offset :
         {CVector2{8.0, 0.0}, CVector2{4.2, 6.5}, CVector2{0.0, 8.0}, CVector2{-4.2, 6.5},
          CVector2{-8.0, 0.0}, CVector2{-4.2, -6.5}, CVector2{0.0, -8.0}, CVector2{4.2, -6.5}}) {
      m_tReadings.emplace_back(0.0, offset);
    }
  }

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace argos
