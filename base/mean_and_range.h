// Mean, lowest and highest of several values, one after the other.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace gauntlet {

// Of no value all are NaN.
class MeanAndRange {
 public:
  void Add(double value) {
    ++count_;
    sum_ += value;
    lowest_ = std::fmin(lowest_, value);
    highest_ = std::fmax(highest_, value);
  }
  void Add(const MeanAndRange& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    lowest_ = std::fmin(lowest_, other.lowest_);
    highest_ = std::fmax(highest_, other.highest_);
  }

  std::uint64_t count() const { return count_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : kNone; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t count_ = 0;
  double sum_ = 0.0;
  double lowest_ = kNone;
  double highest_ = kNone;
};

}  // namespace gauntlet
