// A segment of the plane, from its start to its end.
#pragma once

#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CRay2 {
 public:
  CRay2() = default;
  CRay2(const CVector2& start, const CVector2& end) : start_(start), end_(end) {}

  const CVector2& GetStart() const { return start_; }
  const CVector2& GetEnd() const { return end_; }
  void SetStart(const CVector2& start) { start_ = start; }
  void SetEnd(const CVector2& end) { end_ = end; }
  CRay2(const CVector2& start, const CVector2& direction, Real length) { Set(start, direction, length); }
  CVector2& GetStart() { return start_; }
  CVector2& GetEnd() { return end_; }
  void Set(const CVector2& start, const CVector2& end) {
    start_ = start;
    end_ = end;
  }
  void Set(const CVector2& start, const CVector2& direction, Real length) {
    Set(start, start + length * direction);
  }
  void SetLength(Real length) {
    CVector2 direction;
    GetDirection(direction);
    Set(start_, direction, length);
  }
  Real GetLength() const { return Distance(start_, end_); }
  void GetDirection(CVector2& direction) const { ToVector(direction).Normalize(); }
  void GetInverseDirection(CVector2& direction) const { direction = (CVector2(start_) - end_).Normalize(); }
  CVector2& ToVector(CVector2& vector) const { return vector = CVector2(end_) - start_; }
  // At a share of the way: 0 is the start, 1 the end.
  void GetPoint(CVector2& point, Real share) const { point = start_ + share * (CVector2(end_) - start_); }
  Real GetDistance(Real share) const { return std::fabs(share) * GetLength(); }

 private:
  CVector2 start_;
  CVector2 end_;
};

inline std::ostream& operator<<(std::ostream& stream, const CRay2& ray) {
  return stream << ray.GetStart() << " -> " << ray.GetEnd();
}

}  // namespace argos
