// A segment of space, from its start to its end.
#pragma once

#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CRay3 {
 public:
  CRay3() = default;
  CRay3(const CVector3& start, const CVector3& end) : start_(start), end_(end) {}

  const CVector3& GetStart() const { return start_; }
  const CVector3& GetEnd() const { return end_; }
  void SetStart(const CVector3& start) { start_ = start; }
  void SetEnd(const CVector3& end) { end_ = end; }
  CRay3(const CVector3& start, const CVector3& direction, Real length) { Set(start, direction, length); }
  CVector3& GetStart() { return start_; }
  CVector3& GetEnd() { return end_; }
  void Set(const CVector3& start, const CVector3& end) {
    start_ = start;
    end_ = end;
  }
  void Set(const CVector3& start, const CVector3& direction, Real length) {
    Set(start, start + length * direction);
  }
  void SetLength(Real length) {
    CVector3 direction;
    GetDirection(direction);
    Set(start_, direction, length);
  }
  Real GetLength() const { return Distance(start_, end_); }
  void GetDirection(CVector3& direction) const { ToVector(direction).Normalize(); }
  void GetInverseDirection(CVector3& direction) const { direction = (CVector3(start_) - end_).Normalize(); }
  CVector3& ToVector(CVector3& vector) const { return vector = CVector3(end_) - start_; }
  // At a share of the way: 0 is the start, 1 the end.
  void GetPoint(CVector3& point, Real share) const { point = start_ + share * (CVector3(end_) - start_); }
  Real GetDistance(Real share) const { return std::fabs(share) * GetLength(); }

 private:
  CVector3 start_;
  CVector3 end_;
};

inline std::ostream& operator<<(std::ostream& stream, const CRay3& ray) {
  return stream << ray.GetStart() << " -> " << ray.GetEnd();
}

}  // namespace argos
