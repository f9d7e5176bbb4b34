// A camera that looks ahead; there is none on the robots of Gauntlet.
#pragma once

#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_log.h>

namespace argos {

class CCI_ColoredBlobPerspectiveCameraSensor : public CCI_Sensor {
 public:
  struct SBlob {
    CColor Color;
    SInt32 X = 0;  // pixels of 640
    SInt32 Y = 0;  // pixels of 480
  };
  using TBlobList = std::vector<SBlob*>;
  struct SReadings {
    TBlobList BlobList;
    UInt64 Counter = 0;
  };

  const SReadings& GetReadings() const { return m_sReadings; }

 protected:
  SReadings m_sReadings;
};

}  // namespace argos
