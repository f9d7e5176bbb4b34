// A range of values.
#pragma once

#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

template <typename T>
class CRange {
 public:
  constexpr CRange(const T& min = T(), const T& max = T()) : min_(min), max_(max), span_(max - min) {
    Check();
  }

  constexpr T GetMin() const { return min_; }
  constexpr T GetMax() const { return max_; }
  constexpr T GetSpan() const { return span_; }
  void SetMin(const T& min) { Set(min, max_); }
  void SetMax(const T& max) { Set(min_, max); }
  void Set(const T& min, const T& max) { *this = CRange(min, max); }

  bool WithinMinBoundIncludedMaxBoundIncluded(const T& value) const { return value >= min_ && value <= max_; }
  bool WithinMinBoundIncludedMaxBoundExcluded(const T& value) const { return value >= min_ && value < max_; }
  bool WithinMinBoundExcludedMaxBoundIncluded(const T& value) const { return value > min_ && value <= max_; }
  bool WithinMinBoundExcludedMaxBoundExcluded(const T& value) const { return value > min_ && value < max_; }

  // To the nearer end, in place, what is outside.
  void TruncValue(T& value) const {
    if (value > max_) value = max_;
    if (value < min_) value = min_;
  }
  // Moves by whole spans, in place, until it is inside; both ends are.
  void WrapValue(T& value) const {
    while (value > max_) value -= span_;
    while (value < min_) value += span_;
  }
  // 0 at the minimum and below, 1 at the maximum and above.
  Real NormalizeValue(const T& value) const {
    T inside = value;
    TruncValue(inside);
    if constexpr (std::is_arithmetic_v<T>) {
      return static_cast<Real>(inside - min_) / static_cast<Real>(span_);
    } else {
      return (inside - min_) / span_;
    }
  }
  template <typename U>
  void MapValueIntoRange(U& mapped, const T& value, const CRange<U>& range) const {
    mapped = static_cast<U>(NormalizeValue(value) * range.GetSpan() + range.GetMin());
  }

  friend std::ostream& operator<<(std::ostream& stream, const CRange& range) {
    return stream << range.min_ << ":" << range.max_;
  }
  friend std::istream& operator>>(std::istream& stream, CRange& range) {
    T ends[2];
    ParseValues<T>(stream, 2, ends, ':');
    range.Set(ends[0], ends[1]);
    return stream;
  }

 private:
  constexpr void Check() const {
#ifndef NDEBUG
    if (max_ < min_) throw CARGoSException("CRange: the minimum is greater than the maximum");
#endif
  }

  T min_;
  T max_;
  T span_;
};

}  // namespace argos
