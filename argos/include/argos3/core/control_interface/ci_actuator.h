// What all actuators have in common.
#pragma once

#include <map>
#include <string>

#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_Controller;

class CCI_Actuator : public CBaseConfigurableResource {
 public:
  using TMap = std::map<std::string, CCI_Actuator*>;
};

}  // namespace argos
