// ARGoS' engine for the plane. Only its name: sources include this header without use.
#pragma once

#include <argos3/core/simulator/physics_engine/physics_engine.h>

namespace argos {

class CDynamics2DEngine : public CPhysicsEngine {};

}  // namespace argos
