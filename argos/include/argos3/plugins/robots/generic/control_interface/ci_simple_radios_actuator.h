// What simple radios say; there are none on the robots of Gauntlet.
#pragma once

#include <string>
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/byte_array.h>

namespace argos {

class CCI_SimpleRadiosActuator : public CCI_Actuator {
 public:
  struct SInterface {
    std::string Id;
    std::vector<CByteArray> Messages;
  };
  using TInterfaces = std::vector<SInterface>;

  TInterfaces& GetInterfaces() { return m_tInterfaces; }

 protected:
  TInterfaces m_tInterfaces;
};

}  // namespace argos
