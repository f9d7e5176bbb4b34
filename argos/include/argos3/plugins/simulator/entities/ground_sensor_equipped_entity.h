// Something with ground sensors. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CGroundSensorEquippedEntity : public CEntity {};

}  // namespace argos
