// A body as the physics have it. Only its name: sources include this header without use.
#pragma once

namespace argos {

class CPhysicsModel {};

}  // namespace argos
