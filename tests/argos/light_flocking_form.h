// The robots of argos/example/light_flocking.cc, with the parameters of light_flocking.argos beside it.
#pragma once

#include "controllers/behaviour.h"

namespace gauntlet::argos_form {

controllers::ControllerFactory ExampleFlockers();

}  // namespace gauntlet::argos_form
