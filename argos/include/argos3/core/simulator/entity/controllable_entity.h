// Something that has a controller.
#pragma once

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CControllableEntity : public CEntity {
 public:
  ARGOS_UNAVAILABLE(
      CCI_Controller&, GetController,
      "a controller of Gauntlet does not reach those of other robots; let them speak by range_and_bearing")
};

}  // namespace argos
