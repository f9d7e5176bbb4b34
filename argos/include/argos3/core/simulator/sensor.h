// The simulated side of a sensor. In Gauntlet that is the simulator's own matter; the class is here so that
// sources which mention theirs compile.
#pragma once

#include <argos3/core/simulator/entity/composable_entity.h>

namespace argos {

class CSimulatedSensor {
 public:
  virtual ~CSimulatedSensor() = default;
  virtual void SetRobot(CComposableEntity& robot) = 0;
  virtual void Update() = 0;
};

}  // namespace argos

#define REGISTER_SENSOR(CLASSNAME, LABEL, ...)                                                  \
  static_assert(false, LABEL                                                                    \
                ": Gauntlet's foot-bot has the devices of ARGoS' foot-bot and takes no other; " \
                "leave this source out and let the controller use one of those");
