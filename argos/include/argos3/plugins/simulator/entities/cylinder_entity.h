// A cylinder. Only its name: what stands in the arena is the scenario's matter.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CCylinderEntity : public CEntity {};

}  // namespace argos
