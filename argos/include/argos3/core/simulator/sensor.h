// The simulated side of a device.
#pragma once

#include <argos3/core/simulator/simulated_device.h>
