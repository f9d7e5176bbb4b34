// The simulated side of a sensor. A controller that asks for it gets the readings.
#pragma once

#include <argos3/core/simulator/sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>

namespace argos {

using CFootBotBaseGroundRotZOnlySensor = CCI_FootBotBaseGroundSensor;

}  // namespace argos
