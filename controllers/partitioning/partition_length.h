// How far a robot carries an item before it offers it to another: a constant (static strategy) or learnt
// (dynamic strategy; Buchanan, Pomfret and Timmis 2016, "DPS").
#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {

struct PartitionLengthSettings {
  enum class Rule : std::uint8_t {
    kStatic,
    kSigned,       // DPS-S: a fixed step, up after success, down after failure
    kExponential,  // DPS-E: a step that shrinks the longer a row of successes is
  };

  Rule rule = Rule::kStatic;
  double start = 0.0;    // m
  double least = 0.0;    // m; this and all that follows: of the dynamic rules
  double most = 0.0;     // m
  double gain = 0.0;     // G
  double balance = 0.0;  // alpha, percent: 50 = up as far as down
  double decay = 0.0;    // of DPS-E per success in a row
};

class PartitionLength {
 public:
  explicit PartitionLength(const PartitionLengthSettings& settings)
      : settings_(settings), length_(settings.start) {}

  double value() const { return length_; }
  // An item was found where it was looked for.
  void Succeed() {
    if (settings_.rule == PartitionLengthSettings::Rule::kStatic) return;
    row_ = std::min(row_ + 1, kLongestRow);
    length_ = std::min(length_ + Step(100.0 - settings_.balance), settings_.most);
  }
  // It was not.
  void Fail() {
    if (settings_.rule == PartitionLengthSettings::Rule::kStatic) return;
    row_ = std::max(row_ - 1, -kLongestRow);
    length_ = std::max(length_ - Step(settings_.balance), settings_.least);
  }

 private:
  static constexpr int kLongestRow = 10;

  double Step(double share) const {
    return settings_.rule == PartitionLengthSettings::Rule::kSigned
               ? settings_.gain * share / 1e4
               : settings_.gain / 1e2 * sim::Exp(-settings_.decay * row_);
  }

  PartitionLengthSettings settings_;
  double length_;
  int row_ = 0;  // successes minus failures, within +-kLongestRow
};

}  // namespace gauntlet::controllers
