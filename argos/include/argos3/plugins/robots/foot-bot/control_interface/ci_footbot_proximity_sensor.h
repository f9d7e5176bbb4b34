// Bodies within 0.1 m of the robot: 0, nothing to 1, touching.
#pragma once

#include <argos3/plugins/robots/foot-bot/control_interface/footbot_places.h>

namespace argos {

class CCI_FootBotProximitySensor : public CFootBotRing<CCI_FootBotProximitySensor> {};

}  // namespace argos
