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
  Real GetLength() const { return Distance(start_, end_); }

 private:
  CVector2 start_;
  CVector2 end_;
};

}  // namespace argos
