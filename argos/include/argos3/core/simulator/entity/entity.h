// What stands in the arena.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <argos3/core/simulator/unavailable.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CEntity {
 public:
  virtual ~CEntity() = default;

  ARGOS_UNAVAILABLE(const std::string&, GetId,
                    "a controller of Gauntlet knows its own robot only; use CCI_Controller::GetId")
};

}  // namespace argos
