// How bright it is around the robot: 0, dark to 1.
#pragma once

#include <argos3/plugins/robots/foot-bot/control_interface/footbot_places.h>

namespace argos {

class CCI_FootBotLightSensor : public CFootBotRing<CCI_FootBotLightSensor> {};

}  // namespace argos
