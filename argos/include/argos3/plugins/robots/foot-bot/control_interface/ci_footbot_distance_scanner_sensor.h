// Distances from the rim of the robot, by their angle from the heading.
#pragma once

#include <map>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotDistanceScannerSensor : public CCI_Sensor {
 public:
  // cm; -1: too near, -2: nothing within the range.
  using TReadingsMap = std::map<CRadians, Real>;

  const TReadingsMap& GetReadingsMap() const { return m_tReadingsMap; }            // of both kinds
  const TReadingsMap& GetShortReadingsMap() const { return m_tShortReadingsMap; }  // 0 to 26 cm
  const TReadingsMap& GetLongReadingsMap() const { return m_tLongReadingsMap; }    // 12 to 142 cm

 protected:
  TReadingsMap m_tReadingsMap;
  TReadingsMap m_tShortReadingsMap;
  TReadingsMap m_tLongReadingsMap;
};

}  // namespace argos
