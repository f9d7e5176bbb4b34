// A lamp. What stands in the arena is the scenario's matter.
#pragma once

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/datatypes/color.h>

namespace argos {

class CLightEntity : public CEntity {
 public:
  ARGOS_UNAVAILABLE(CColor, GetColor,
                    "a controller of Gauntlet sees lamps by its camera and its light sensors")
  ARGOS_UNAVAILABLE(Real, GetIntensity,
                    "a controller of Gauntlet sees lamps by its camera and its light sensors")
  ARGOS_UNAVAILABLE(const CVector3&, GetPosition,
                    "a controller of Gauntlet sees lamps by its camera and its light sensors")
};

}  // namespace argos
