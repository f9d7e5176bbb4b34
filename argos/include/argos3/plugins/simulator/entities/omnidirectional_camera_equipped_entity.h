// Something with a camera that looks all around. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class COmnidirectionalCameraEquippedEntity : public CEntity {};

}  // namespace argos
