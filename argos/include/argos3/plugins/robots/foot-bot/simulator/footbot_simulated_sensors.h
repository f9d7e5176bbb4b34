// The simulated sides of sensors. A controller that asks for one gets the readings.
#pragma once

#include <argos3/core/simulator/sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_motor_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>

namespace argos {

using CFootBotBaseGroundRotZOnlySensor = CCI_FootBotBaseGroundSensor;
using CFootBotLightRotZOnlySensor = CCI_FootBotLightSensor;
using CFootBotMotorGroundRotZOnlySensor = CCI_FootBotMotorGroundSensor;
using CFootBotProximityDefaultSensor = CCI_FootBotProximitySensor;

}  // namespace argos
