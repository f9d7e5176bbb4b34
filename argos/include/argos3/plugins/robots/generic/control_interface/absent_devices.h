// Devices that there are none of on the robots of Gauntlet: sources that mention them compile, and asking for
// one throws.
#pragma once

#include <string>
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_log.h>

namespace argos {

// A camera that looks ahead.
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

// How far the wheels have turned; on the robots that ARGoS simulates there is none either.
class CCI_FootBotEncoderSensor : public CCI_Sensor {
 public:
  struct SReading {
    Real CoveredDistanceLeftWheel = 0.0;   // cm
    Real CoveredDistanceRightWheel = 0.0;  // cm
    Real WheelAxisLength = 14.0;           // cm
  };

  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

// A radio, and what it says or hears.
struct SSimpleRadio {
  std::string Id;
  std::vector<CByteArray> Messages;
};

class CCI_SimpleRadiosActuator : public CCI_Actuator {
 public:
  using SInterface = SSimpleRadio;
  using TInterfaces = std::vector<SInterface>;

  TInterfaces& GetInterfaces() { return m_tInterfaces; }

 protected:
  TInterfaces m_tInterfaces;
};

class CCI_SimpleRadiosSensor : public CCI_Sensor {
 public:
  using SInterface = SSimpleRadio;
  using TInterfaces = std::vector<SInterface>;

  const TInterfaces& GetInterfaces() const { return m_tInterfaces; }

 protected:
  TInterfaces m_tInterfaces;
};

}  // namespace argos
