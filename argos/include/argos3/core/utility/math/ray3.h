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
  Real GetLength() const { return Distance(start_, end_); }

 private:
  CVector3 start_;
  CVector3 end_;
};

}  // namespace argos
