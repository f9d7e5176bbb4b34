// What simple radios hear; there are none on the robots of Gauntlet.
#pragma once

#include <string>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/byte_array.h>

namespace argos {

class CCI_SimpleRadiosSensor : public CCI_Sensor {
 public:
  struct SInterface {
    std::string Id;
    std::vector<CByteArray> Messages;
  };
  using TInterfaces = std::vector<SInterface>;

  const TInterfaces& GetInterfaces() const { return m_tInterfaces; }

 protected:
  TInterfaces m_tInterfaces;
};

}  // namespace argos
