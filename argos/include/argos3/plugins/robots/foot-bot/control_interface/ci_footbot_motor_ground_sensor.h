// The floor below the wheels, in 4 places.
#pragma once

#include <argos3/plugins/robots/foot-bot/control_interface/footbot_places.h>

namespace argos {

class CCI_FootBotMotorGroundSensor : public CFootBotGround<CCI_FootBotMotorGroundSensor> {
 public:
  CCI_FootBotMotorGroundSensor() : CFootBotGround({{6.3, 1.16}, {-6.3, 1.16}, {-6.3, -1.16}, {6.3, -1.16}}) {}
};

}  // namespace argos
