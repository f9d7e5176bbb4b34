// How far the turret is turned.
#pragma once

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotTurretEncoderSensor : public CCI_Sensor {
 public:
  static constexpr CRange<CRadians> ANGULAR_RANGE{CRadians(-ARGOS_PI), CRadians(ARGOS_PI)};

  const CRadians& GetRotation() const { return m_cRotation; }

 protected:
  CRadians m_cRotation;
};

}  // namespace argos
