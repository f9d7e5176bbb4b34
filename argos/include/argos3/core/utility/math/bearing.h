// An angle that a sensor gives. It brings its sine and cosine along, because most controllers want a vector
// of that direction next; for everything else it is a CRadians.
#pragma once

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>

#include "base/double_bits.h"

namespace argos {

class CBearing : public CRadians {
 public:
  constexpr CBearing() = default;
  explicit CBearing(Real value) : CBearing(CRadians(value)) {}
  // Without its sine and cosine. Implicit, so that readings take any angle.
  CBearing(const CRadians& angle) : CRadians(angle), known_(~gauntlet::BitsOf(angle.GetValue())) {}
  CBearing(Real value, Real sine, Real cosine)
      : CRadians(value), known_(gauntlet::BitsOf(value)), sine_(sine), cosine_(cosine) {}

  // Whether it still has the value that the other two are of.
  bool HasSine() const { return gauntlet::BitsOf(GetValue()) == known_; }
  Real GetSine() const { return sine_; }
  Real GetCosine() const { return cosine_; }

 private:
  UInt64 known_ = 0;  // the bits of the angle whose sine and cosine these are
  Real sine_ = 0.0;
  Real cosine_ = 1.0;
};

inline void SinCos(const CBearing& angle, Real& sine, Real& cosine) {
  if (!angle.HasSine()) return SinCos(static_cast<const CRadians&>(angle), sine, cosine);
  sine = angle.GetSine();
  cosine = angle.GetCosine();
}
inline Real Sin(const CBearing& angle) {
  return angle.HasSine() ? angle.GetSine() : Sin(static_cast<const CRadians&>(angle));
}
inline Real Cos(const CBearing& angle) {
  return angle.HasSine() ? angle.GetCosine() : Cos(static_cast<const CRadians&>(angle));
}

// Of a bearing and any other angle too, for which the templates find no common type.
inline CRadians Min(const CRadians& one, const CRadians& other) {
  return one < other ? one : other;
}
inline CRadians Max(const CRadians& one, const CRadians& other) {
  return one > other ? one : other;
}

}  // namespace argos
