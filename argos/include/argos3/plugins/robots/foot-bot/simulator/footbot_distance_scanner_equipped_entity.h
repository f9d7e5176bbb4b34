// Something with the foot-bot's distance scanner. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CFootBotDistanceScannerEquippedEntity : public CEntity {};

}  // namespace argos
