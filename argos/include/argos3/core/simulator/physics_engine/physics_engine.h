// How fast time goes.
#pragma once

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CPhysicsEngine {
 public:
  static Real GetSimulationClockTick() { return 0.1; }          // s
  static Real GetInverseSimulationClockTick() { return 10.0; }  // ticks in a second
};

}  // namespace argos
