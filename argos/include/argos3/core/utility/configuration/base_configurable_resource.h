// What is initialised by parameters.
#pragma once

#include <argos3/core/utility/configuration/argos_configuration.h>

namespace argos {

class CBaseConfigurableResource {
 public:
  virtual ~CBaseConfigurableResource() = default;
  virtual void Init(TConfigurationNode& /*parameters*/) {}
  virtual void Reset() {}
  virtual void Destroy() {}
};

}  // namespace argos
