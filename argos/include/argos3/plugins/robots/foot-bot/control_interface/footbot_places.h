// Sensors that read a value at several places of the robot. Each has a class of readings of its own.
#pragma once

#include <initializer_list>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/bearing.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

// In 24 directions: reading i at 7.5 + 15 i degrees, in (-180, 180].
template <typename Sensor>
class CFootBotRing : public CCI_Sensor {
 public:
  struct SReading {
    Real Value = 0.0;
    CBearing Angle;  // from the heading

    SReading() = default;
    SReading(Real value, const CRadians& angle) : Value(value), Angle(angle) {}
  };
  using TReadings = std::vector<SReading>;

  CFootBotRing() {
    for (int i = 0; i < 24; ++i) {
      m_tReadings.emplace_back(0.0, CRadians((i + 0.5) * ARGOS_PI / 12.0).SignedNormalize());
    }
  }

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

// The floor below: 0 black to 1 white.
template <typename Sensor>
class CFootBotGround : public CCI_Sensor {
 public:
  struct SReading {
    Real Value = 0.0;
    CVector2 Offset;  // cm from the robot's centre: x ahead, y left

    SReading() = default;
    SReading(Real value, const CVector2& offset) : Value(value), Offset(offset) {}
  };
  using TReadings = std::vector<SReading>;

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  CFootBotGround(std::initializer_list<CVector2> places) {
    for (const CVector2& place : places) m_tReadings.emplace_back(0.0, place);
  }

  TReadings m_tReadings;
};

}  // namespace argos
