// LEDs and lamps around the robot. It reads from Enable() on.
#pragma once

#include <fstream>
#include <iomanip>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/bearing.h>

namespace argos {

class CCI_ColoredBlobOmnidirectionalCameraSensor : public CCI_Sensor {
 public:
  struct SBlob {
    CColor Color;
    CBearing Angle;       // from the heading
    Real Distance = 0.0;  // cm
  };
  using TBlobList = std::vector<SBlob*>;
  // The blobs are valid until the sensor reads again.
  struct SReadings {
    TBlobList BlobList;
    UInt64 Counter = 0;  // of the times it has read
  };

  const SReadings& GetReadings() const { return m_sReadings; }

 protected:
  SReadings m_sReadings;
};

}  // namespace argos
