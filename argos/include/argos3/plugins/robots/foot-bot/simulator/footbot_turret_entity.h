// The foot-bot's turret. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/entity/entity.h>

namespace argos {

class CFootBotTurretEntity : public CEntity {};

}  // namespace argos
