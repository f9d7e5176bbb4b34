// Something with wheels. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CWheeledEntity : public CEntity {};

}  // namespace argos
