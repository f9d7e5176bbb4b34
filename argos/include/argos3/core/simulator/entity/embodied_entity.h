// The body of something in the arena.
#pragma once

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/math/ray3.h>

namespace argos {

// Where a part of it is.
struct SAnchor {
  CVector3 Position;
  CQuaternion Orientation;
};

class CEmbodiedEntity : public CEntity {
 public:
  ARGOS_UNAVAILABLE(
      const SAnchor&, GetOriginAnchor,
      "a controller of Gauntlet sees no other bodies; its own place is read by the positioning sensor")
};

}  // namespace argos
