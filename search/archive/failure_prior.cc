#include "search/archive/failure_prior.h"

#include <algorithm>

namespace gauntlet {
namespace {

constexpr double kRunsBefore = 3.0;       // that count before there are any
constexpr double kFewestPriorRuns = 0.1;  // that the distribution is worth, beside those of a layout
constexpr double kMostPriorRuns = 10.0;

int RunsOf(const FailureTally& tally) {
  return tally.runs() + tally.errors;
}

}  // namespace

void FailurePrior::Count::Add(const FailureTally& more) {
  failures += static_cast<std::uint64_t>(more.failures);
  runs += static_cast<std::uint64_t>(RunsOf(more));
}

double FailurePrior::Count::Share(double failures_before) const {
  return (static_cast<double>(failures) + failures_before) / (static_cast<double>(runs) + kRunsBefore);
}

void FailurePrior::Learn(const FailureTally& before, const FailureTally& more) {
  if (RunsOf(before) == 0) first_.Add(more);
  if (RunsOf(before) == RunsOf(more) && before.failures > 0) second_.Add(more);
}

double FailurePrior::Expected(const FailureTally& tally) const {
  const double mean = first_.Share(1.0);
  const double again = second_.Share(2.0);
  // Beta(mean n, (1 - mean) n), whose mean after one failure is (mean n + 1) / (n + 1) = again.
  const double runs = again > mean
                          ? std::clamp((1.0 - again) / (again - mean), kFewestPriorRuns, kMostPriorRuns)
                          : kMostPriorRuns;
  return (mean * runs + tally.failures) / (runs + RunsOf(tally));
}

void FailurePrior::Save(CanonicalEncoder& encoder) const {
  for (const Count& count : {first_, second_}) {
    encoder.Uint(count.failures);
    encoder.Uint(count.runs);
  }
}

void FailurePrior::Restore(CanonicalDecoder& decoder) {
  for (Count* count : {&first_, &second_}) {
    count->failures = decoder.Uint();
    count->runs = decoder.Uint();
  }
}

}  // namespace gauntlet
