// The simulated sides of sensors and actuators. In Gauntlet they are the simulator's own matter; the classes
// are here so that sources which mention theirs compile.
#pragma once

#include <argos3/core/simulator/only_names.h>

namespace argos {

class CSimulatedDevice {
 public:
  virtual ~CSimulatedDevice() = default;
  virtual void SetRobot(CComposableEntity& robot) = 0;
  virtual void Update() = 0;
};

class CSimulatedSensor : public CSimulatedDevice {};
class CSimulatedActuator : public CSimulatedDevice {};

}  // namespace argos

#define ARGOS_NO_OTHER_DEVICE(LABEL)                                                            \
  static_assert(false, LABEL                                                                    \
                ": Gauntlet's foot-bot has the devices of ARGoS' foot-bot and takes no other; " \
                "leave this source out and let the controller use one of those");
#define REGISTER_SENSOR(CLASSNAME, LABEL, ...) ARGOS_NO_OTHER_DEVICE(LABEL)
#define REGISTER_ACTUATOR(CLASSNAME, LABEL, ...) ARGOS_NO_OTHER_DEVICE(LABEL)
