// The floor.
#pragma once

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CFloorEntity : public CEntity {
 public:
  ARGOS_UNAVAILABLE(void, SetChanged, "the scenario paints the floor in Gauntlet; read it by a ground sensor")
};

}  // namespace argos
