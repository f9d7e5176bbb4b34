#include "analysis/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/rank_test.h"
#include "base/check.h"
#include "sim/random/random_stream.h"

namespace gauntlet::analysis {
namespace {

std::vector<double> Resample(const std::vector<std::vector<double>>& clusters, sim::RandomStream& random) {
  std::vector<double> values;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const std::vector<double>& drawn = clusters[random.Below(static_cast<std::uint32_t>(clusters.size()))];
    values.insert(values.end(), drawn.begin(), drawn.end());
  }
  return values;
}

}  // namespace

Interval ClusterBootstrapA(const std::vector<std::vector<double>>& first,
                           const std::vector<std::vector<double>>& second, double confidence, int resamples,
                           std::uint64_t seed) {
  GAUNTLET_CHECK(!first.empty() && !second.empty() && resamples > 0,
                 "a bootstrap needs clusters and resamples");
  std::vector<double> statistics;
  for (int i = 0; i < resamples; ++i) {
    sim::RandomStream random(seed, sim::StreamPurpose::kStatistics, static_cast<std::uint32_t>(i));
    const std::vector<double> a = Resample(first, random);
    const std::vector<double> b = Resample(second, random);
    statistics.push_back(MannWhitney(a, b).a);
  }
  std::sort(statistics.begin(), statistics.end());
  const auto at = [&](double probability) {
    const double position = probability * static_cast<double>(statistics.size() - 1);
    return statistics[static_cast<std::size_t>(std::lround(position))];
  };
  return {at((1.0 - confidence) / 2.0), at((1.0 + confidence) / 2.0)};
}

}  // namespace gauntlet::analysis
