// Something with a gripper. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CGripperEquippedEntity : public CEntity {};

}  // namespace argos
