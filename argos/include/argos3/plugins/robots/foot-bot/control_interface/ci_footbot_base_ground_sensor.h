// The floor below the rim, in 8 places: black or white.
#pragma once

#include <argos3/plugins/robots/foot-bot/control_interface/footbot_places.h>

namespace argos {

class CCI_FootBotBaseGroundSensor : public CFootBotGround<CCI_FootBotBaseGroundSensor> {
 public:
  CCI_FootBotBaseGroundSensor()
      : CFootBotGround({{8.0, 0.0},
                        {4.2, 6.5},
                        {0.0, 8.0},
                        {-4.2, 6.5},
                        {-8.0, 0.0},
                        {-4.2, -6.5},
                        {0.0, -8.0},
                        {4.2, -6.5}}) {}
};

}  // namespace argos
