#include "controllers/partitioning/partition_length.h"

#include <algorithm>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr int kLongestRow = 10;

}  // namespace

double PartitionLength::Step(double share) const {
  switch (settings_.rule) {
    case PartitionLengthSettings::Rule::kStatic:
      return 0.0;
    case PartitionLengthSettings::Rule::kSigned:
      return settings_.gain * share / 1e4;
    case PartitionLengthSettings::Rule::kExponential:
      return settings_.gain / 1e2 * sim::Exp(-settings_.decay * row_);
  }
  return 0.0;
}

void PartitionLength::Succeed() {
  if (settings_.rule == PartitionLengthSettings::Rule::kStatic) return;
  row_ = std::min(row_ + 1, kLongestRow);
  length_ = std::min(length_ + Step(100.0 - settings_.balance), settings_.most);
}

void PartitionLength::Fail() {
  if (settings_.rule == PartitionLengthSettings::Rule::kStatic) return;
  row_ = std::max(row_ - 1, -kLongestRow);
  length_ = std::max(length_ - Step(settings_.balance), settings_.least);
}

}  // namespace gauntlet::controllers
