// The simulated side of a sensor.
#pragma once

#include <argos3/plugins/robots/foot-bot/simulator/footbot_simulated_sensors.h>
