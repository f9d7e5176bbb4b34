#include "analysis/statistics/parameter_analysis.h"

#include <algorithm>

#include "analysis/statistics/multiple_tests.h"
#include "base/check.h"
#include "sim/random/random_stream.h"

namespace gauntlet::analysis {
namespace {

ComparedSet Singletons(const char* name, const std::vector<double>& values) {
  ComparedSet set{name, {}};
  for (const double value : values) set.clusters.push_back({value});
  return set;
}

}  // namespace

double NormalisedA(double a) {
  return std::max(a, 1.0 - a);
}

bool Exceeds(double a) {
  return EffectOf(a) == "large";
}

Consistency AnalyseConsistency(std::span<const std::vector<double>> sets, std::vector<double>* scores) {
  GAUNTLET_CHECK(sets.size() >= 2, "consistency is that of several sets");
  std::vector<double> normalised;
  for (const std::vector<double>& other : sets.subspan(1)) {
    GAUNTLET_CHECK(other.size() == sets.front().size(), "the sets have to be of one size");
    const double a = MannWhitney(sets.front(), other).a;
    normalised.push_back(NormalisedA(a));
    if (scores != nullptr) scores->push_back(a);
  }
  const Description of_all = Describe(normalised);
  return {sets.front().size(), of_all.median, of_all.maximum};
}

std::vector<std::vector<double>> DrawSets(std::span<const double> values, std::size_t size,
                                          std::size_t number, std::uint64_t seed) {
  GAUNTLET_CHECK(!values.empty() && size > 0, "sets are drawn from values");
  sim::RandomStream random(seed, sim::StreamPurpose::kStatistics);
  std::vector<std::vector<double>> sets(number);
  for (std::vector<double>& set : sets) {
    for (std::size_t i = 0; i < size; ++i)
      set.push_back(values[random.Below(static_cast<std::uint32_t>(values.size()))]);
  }
  return sets;
}

std::optional<std::size_t> EnoughRepeats(std::span<const Consistency> ascending_sizes) {
  std::optional<std::size_t> enough;
  for (const Consistency& one : ascending_sizes) {
    if (Exceeds(one.max_a)) {
      enough.reset();
    } else if (!enough) {
      enough = one.size;
    }
  }
  return enough;
}

Result<std::vector<Robustness>> AnalyseRobustness(const std::vector<double>& baseline,
                                                  std::span<const std::vector<double>> changed) {
  std::vector<Robustness> all;
  std::vector<double> p;
  for (const std::vector<double>& values : changed) {
    TRY(auto comparison,
        Compare(Singletons("the baseline", baseline), Singletons("a changed parameter", values)));
    Robustness& one = all.emplace_back();
    one.comparison = std::move(comparison);
    one.exceeds = Exceeds(one.comparison.test.a);
    p.push_back(one.comparison.p.value());
  }
  const std::vector<double> adjusted = HolmAdjusted(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_holm = adjusted[i];
  return all;
}

}  // namespace gauntlet::analysis
