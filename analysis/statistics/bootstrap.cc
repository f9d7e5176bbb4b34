#include "analysis/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"
#include "base/check.h"
#include "sim/random/random_stream.h"

namespace gauntlet::analysis {
namespace {

using PlacedClusters = std::vector<std::vector<std::uint32_t>>;

// The values replaced by their places in `distinct`: what A depends on.
PlacedClusters Place(const Clusters& clusters, const std::vector<double>& distinct) {
  PlacedClusters placed(clusters.size());
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    for (const double value : clusters[i]) {
      const auto place = std::lower_bound(distinct.begin(), distinct.end(), value) - distinct.begin();
      placed[i].push_back(static_cast<std::uint32_t>(place));
    }
  }
  return placed;
}

// How often each place comes in as many clusters as there are, drawn with replacement.
void Resample(const PlacedClusters& clusters, sim::RandomStream& random, std::vector<std::uint32_t>& counts) {
  std::fill(counts.begin(), counts.end(), 0);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const auto drawn = random.Below(static_cast<std::uint32_t>(clusters.size()));
    for (const std::uint32_t place : clusters[drawn]) ++counts[place];
  }
}

double CountedA(const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& second) {
  double u2 = 0.0;  // twice the pairs in which the first is larger, ties counting half
  double size1 = 0.0;
  double size2 = 0.0;
  for (std::size_t place = 0; place < first.size(); ++place) {
    u2 += first[place] * (2.0 * size2 + second[place]);
    size1 += first[place];
    size2 += second[place];
  }
  return u2 / (2.0 * size1 * size2);
}

double VarianceOfMean(std::span<const double> values) {
  const double sd = Describe(values).sd.value();
  return sd * sd / static_cast<double>(values.size());
}

Clusters Singletons(std::span<const double> values) {
  Clusters clusters;
  for (const double value : values) clusters.push_back({value});
  return clusters;
}

}  // namespace

Interval ClusterBootstrapA(const Clusters& first, const Clusters& second, double confidence, int resamples,
                           std::uint64_t seed) {
  GAUNTLET_CHECK(!first.empty() && !second.empty() && resamples > 0,
                 "a bootstrap needs clusters and resamples");
  CheckConfidence(confidence);
  std::vector<double> distinct;
  for (const Clusters* clusters : {&first, &second}) {
    for (const std::vector<double>& cluster : *clusters) {
      GAUNTLET_CHECK(!cluster.empty(), "a cluster must not be empty");
      distinct.insert(distinct.end(), cluster.begin(), cluster.end());
    }
  }
  for (const double value : distinct) GAUNTLET_CHECK(!std::isnan(value), "a bootstrap cannot order NaN");
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());

  const PlacedClusters placed1 = Place(first, distinct);
  const PlacedClusters placed2 = Place(second, distinct);
  std::vector<std::uint32_t> counts1(distinct.size());
  std::vector<std::uint32_t> counts2(distinct.size());
  std::vector<double> statistics;
  for (int i = 0; i < resamples; ++i) {
    sim::RandomStream random(seed, sim::StreamPurpose::kStatistics, static_cast<std::uint32_t>(i));
    Resample(placed1, random, counts1);
    Resample(placed2, random, counts2);
    statistics.push_back(CountedA(counts1, counts2));
  }
  return {Quantile(statistics, (1.0 - confidence) / 2.0), Quantile(statistics, (1.0 + confidence) / 2.0)};
}

Interval BootstrapA(std::span<const double> first, std::span<const double> second, double confidence,
                    int resamples, std::uint64_t seed) {
  return ClusterBootstrapA(Singletons(first), Singletons(second), confidence, resamples, seed);
}

Interval LargeSampleIntervalA(std::span<const double> first, std::span<const double> second,
                              double confidence) {
  CheckConfidence(confidence);
  GAUNTLET_CHECK(first.size() > 1 && second.size() > 1, "a variance needs two values in either set");
  std::vector<double> all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  // The share of the other set that a value exceeds, from its ranks among all and among its own.
  std::vector<double> among_all = MidRanks(all);
  const std::span<double> placements1 = std::span(among_all).first(first.size());
  const std::span<double> placements2 = std::span(among_all).last(second.size());
  const auto subtract_own = [](std::span<double> placements, std::span<const double> own,
                               std::size_t others) {
    const std::vector<double> among_own = MidRanks(own);
    for (std::size_t i = 0; i < placements.size(); ++i) {
      placements[i] = (placements[i] - among_own[i]) / static_cast<double>(others);
    }
  };
  subtract_own(placements1, first, second.size());
  subtract_own(placements2, second, first.size());
  const double a = Describe(placements1).mean;
  const double half = NormalQuantile(0.5 + confidence / 2.0) *
                      std::sqrt(VarianceOfMean(placements1) + VarianceOfMean(placements2));
  return {std::max(0.0, a - half), std::min(1.0, a + half)};
}

}  // namespace gauntlet::analysis
