// A segment of the plane.
#pragma once

#include <argos3/core/utility/math/ray.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CRay2 : public CRay<CVector2> {
 public:
  using CRay<CVector2>::CRay;
};

}  // namespace argos
