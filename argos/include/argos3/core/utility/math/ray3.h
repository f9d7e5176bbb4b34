// A segment of space.
#pragma once

#include <argos3/core/utility/math/ray.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CRay3 : public CRay<CVector3> {
 public:
  using CRay<CVector3>::CRay;
};

}  // namespace argos
