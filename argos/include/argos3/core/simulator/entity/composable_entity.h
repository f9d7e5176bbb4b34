// A thing made of things. Only its name: what stands in the arena is the scenario's matter.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CComposableEntity : public CEntity {};

}  // namespace argos
