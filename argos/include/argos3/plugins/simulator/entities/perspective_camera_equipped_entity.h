// Something with a camera that looks ahead. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CPerspectiveCameraEquippedEntity : public CEntity {};

}  // namespace argos
