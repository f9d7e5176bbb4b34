#include "analysis/statistics/unseen_types.h"

namespace gauntlet::analysis {

UnseenTypes EstimateUnseenTypes(std::span<const std::uint64_t> failures_per_type) {
  UnseenTypes estimate;
  for (const std::uint64_t count : failures_per_type) {
    estimate.failures += count;
    if (count > 0) ++estimate.seen;
    if (count == 1) ++estimate.seen_once;
    if (count == 2) ++estimate.seen_twice;
  }
  if (estimate.failures == 0) return estimate;
  const auto n = static_cast<double>(estimate.failures);
  const auto once = static_cast<double>(estimate.seen_once);
  const auto twice = static_cast<double>(estimate.seen_twice);
  const double unseen = once * (once - 1.0) / (2.0 * (twice + 1.0));
  estimate.chao1 = static_cast<double>(estimate.seen) + unseen;
  estimate.chao1_of_sample = static_cast<double>(estimate.seen) + (n - 1.0) / n * unseen;
  estimate.chance_of_new = once / n;
  return estimate;
}

double RarefiedTypes(std::span<const std::uint64_t> failures_per_type, std::uint64_t failures) {
  std::uint64_t all = 0;
  for (const std::uint64_t count : failures_per_type) all += count;
  double types = 0.0;
  for (const std::uint64_t count : failures_per_type) {
    if (count == 0) continue;
    double missed = 1.0;  // the chance that none of them is drawn
    for (std::uint64_t i = 0; i < failures && missed > 0.0; ++i) {
      missed *= count + i >= all ? 0.0 : static_cast<double>(all - count - i) / static_cast<double>(all - i);
    }
    types += 1.0 - missed;
  }
  return types;
}

}  // namespace gauntlet::analysis
