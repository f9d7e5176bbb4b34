// What segments of the plane and of space have in common: they go from a start to an end.
#pragma once

#include <cmath>
#include <iostream>

#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <typename Vector>
class CRay {
 public:
  CRay() = default;
  CRay(const Vector& start, const Vector& end) : start_(start), end_(end) {}

  const Vector& GetStart() const { return start_; }
  const Vector& GetEnd() const { return end_; }
  void SetStart(const Vector& start) { start_ = start; }
  void SetEnd(const Vector& end) { end_ = end; }
  CRay(const Vector& start, const Vector& direction, Real length) { Set(start, direction, length); }
  Vector& GetStart() { return start_; }
  Vector& GetEnd() { return end_; }
  void Set(const Vector& start, const Vector& end) {
    start_ = start;
    end_ = end;
  }
  void Set(const Vector& start, const Vector& direction, Real length) {
    Set(start, start + length * direction);
  }
  void SetLength(Real length) {
    Vector direction;
    GetDirection(direction);
    Set(start_, direction, length);
  }
  Real GetLength() const { return Distance(start_, end_); }
  void GetDirection(Vector& direction) const { ToVector(direction).Normalize(); }
  void GetInverseDirection(Vector& direction) const { direction = (Vector(start_) - end_).Normalize(); }
  Vector& ToVector(Vector& vector) const { return vector = Vector(end_) - start_; }
  // At a share of the way: 0 is the start, 1 the end.
  void GetPoint(Vector& point, Real share) const { point = start_ + share * (Vector(end_) - start_); }
  Real GetDistance(Real share) const { return std::fabs(share) * GetLength(); }

 private:
  Vector start_;
  Vector end_;
};

template <typename Vector>
std::ostream& operator<<(std::ostream& stream, const CRay<Vector>& ray) {
  return stream << ray.GetStart() << " -> " << ray.GetEnd();
}

}  // namespace argos
