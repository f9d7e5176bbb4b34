// What a robot hears from those around it.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/bearing.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CCI_RangeAndBearingSensor : public CCI_Sensor {
 public:
  struct SPacket {
    Real Range = 0.0;            // cm
    CBearing HorizontalBearing;  // from the heading
    CRadians VerticalBearing;
    CByteArray Data;
  };
  using TReadings = std::vector<SPacket>;

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace argos
