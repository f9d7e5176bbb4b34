// The robot as ARGoS' simulator sees it.
#pragma once

#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>

namespace argos {

class CFootBotEntity : public CComposableEntity {
 public:
  ARGOS_UNAVAILABLE(
      CControllableEntity&, GetControllableEntity,
      "a controller of Gauntlet does not reach other robots; let them speak by range_and_bearing")
  ARGOS_UNAVAILABLE(
      CEmbodiedEntity&, GetEmbodiedEntity,
      "a controller of Gauntlet sees no other bodies; its own place is read by the positioning sensor")
};

}  // namespace argos
