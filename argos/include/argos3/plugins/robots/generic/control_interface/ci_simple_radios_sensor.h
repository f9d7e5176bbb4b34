// A device that the robots of Gauntlet have not.
#pragma once

#include <argos3/plugins/robots/generic/control_interface/absent_devices.h>
