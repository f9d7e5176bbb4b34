// What all sensors have in common.
#pragma once

#include <map>
#include <string>

#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_Controller;

class CCI_Sensor : public CBaseConfigurableResource {
 public:
  using TMap = std::map<std::string, CCI_Sensor*>;

  // A disabled sensor keeps its last readings.
  virtual void Enable() { enabled_ = true; }
  virtual void Disable() { enabled_ = false; }
  bool IsEnabled() const { return enabled_; }
  bool IsDisabled() const { return !enabled_; }

 private:
  bool enabled_ = false;
};

}  // namespace argos
