// The transcendental functions of ARGoS' interface: those of our simulator, whose bits do not depend on the
// processor.
#include <cmath>

#include "sim/geometry/trigonometry.h"

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/vector3.h>

// They are macros of ARGoS.
#undef Exp
#undef Log

namespace argos {

namespace sim = gauntlet::sim;

namespace reproducible {

Real Exponential(Real value) {
  return sim::Exp(value);
}
Real Logarithm(Real value) {
  return sim::Log(value);
}

}  // namespace reproducible

namespace {

// one - other in [-half a turn, half a turn).
Real Difference(Real one, Real other, Real half_turn) {
  const Real shifted = std::fmod(one - other + half_turn, 2.0 * half_turn);
  return (shifted < 0.0 ? shifted + 2.0 * half_turn : shifted) - half_turn;
}

}  // namespace

CRadians NormalizedDifference(const CRadians& one, const CRadians& other) {
  return CRadians(Difference(one.GetValue(), other.GetValue(), ARGOS_PI));
}
CDegrees NormalizedDifference(const CDegrees& one, const CDegrees& other) {
  return CDegrees(Difference(one.GetValue(), other.GetValue(), 180.0));
}

Real Sin(const CRadians& angle) {
  return sim::Sin(angle.GetValue());
}
Real Cos(const CRadians& angle) {
  return sim::Cos(angle.GetValue());
}
Real Tan(const CRadians& angle) {
  const sim::SinCos both = sim::SineCosine(angle.GetValue());
  return both.sin / both.cos;
}
void SinCos(const CRadians& angle, Real& sine, Real& cosine) {
  const sim::SinCos both = sim::SineCosine(angle.GetValue());
  sine = both.sin;
  cosine = both.cos;
}
CRadians ASin(Real value) {
  return CRadians(sim::Atan2(value, std::sqrt((1.0 - value) * (1.0 + value))));
}
CRadians ACos(Real value) {
  return CRadians(sim::Atan2(std::sqrt((1.0 - value) * (1.0 + value)), value));
}
CRadians ATan2(Real y, Real x) {
  return CRadians(sim::Atan2(y, x));
}

std::ostream& operator<<(std::ostream& stream, const CRadians& angle) {
  return stream << "CRadians(" << angle.GetValue() << " -> " << ToDegrees(angle).GetValue() << " degrees)";
}
std::ostream& operator<<(std::ostream& stream, const CDegrees& angle) {
  return stream << "CDegrees(" << angle.GetValue() << ")";
}

void CVector3::ToSphericalCoords(Real& length, CRadians& inclination, CRadians& azimuth) const {
  length = Length();
  inclination = ACos(GetZ() / length);
  azimuth = GetZAngle();
}

CVector3& CVector3::FromSphericalCoords(Real length, const CRadians& inclination, const CRadians& azimuth) {
  const Real flat = length * Sin(inclination);
  return Set(flat * Cos(azimuth), flat * Sin(azimuth), length * Cos(inclination));
}

CVector3& CVector3::RotateX(const CRadians& angle) {
  const CVector2 turned = CVector2(GetY(), GetZ()).Rotate(angle);
  return Set(GetX(), turned.GetX(), turned.GetY());
}
CVector3& CVector3::RotateY(const CRadians& angle) {
  const CVector2 turned = CVector2(GetZ(), GetX()).Rotate(angle);
  return Set(turned.GetY(), GetY(), turned.GetX());
}
CVector3& CVector3::RotateZ(const CRadians& angle) {
  const CVector2 turned = CVector2(GetX(), GetY()).Rotate(angle);
  return Set(turned.GetX(), turned.GetY(), GetZ());
}

}  // namespace argos
