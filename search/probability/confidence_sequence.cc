#include "search/probability/confidence_sequence.h"

#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr double kSpread = 2.0;  // of the mixture; chosen so that no interval of 1e5 trials is twice as wide
constexpr double kFarthest = 30.0;  // log odds between which ends are looked for

// The logarithm of the gamma function (Stirling's series), to 1e-10, by operations that are the same on every
// machine.
double LogGamma(double x) {
  double shift = 0.0;
  for (; x < 10.0; x += 1.0) shift += sim::Log(x);
  constexpr double kHalfLogTwoPi = 0.9189385332046727;
  const double square = 1.0 / (x * x);
  const double series = (1.0 / 12.0 - square * (1.0 / 360.0 - square / 1260.0)) / x;
  return (x - 0.5) * sim::Log(x) - x + kHalfLogTwoPi + series - shift;
}

// The logarithm of the mixture against p.
double Evidence(double hits, double trials, double p) {
  const double a = kSpread / (1.0 - p);
  const double b = kSpread / p;
  const double misses = trials - hits;
  return LogGamma(a + hits) - LogGamma(a) + LogGamma(b + misses) - LogGamma(b) - LogGamma(a + b + trials) +
         LogGamma(a + b) - hits * sim::Log(p) - misses * sim::Log(1.0 - p);
}

double ProbabilityAt(double log_odds) {
  return 1.0 / (1.0 + sim::Exp(-log_odds));
}

}  // namespace

analysis::Interval ConfidenceSequence(std::uint64_t hits, std::uint64_t trials, double confidence) {
  if (trials == 0) return {0.0, 1.0};
  const double enough = -sim::Log(1.0 - confidence);
  const auto k = static_cast<double>(hits);
  const auto n = static_cast<double>(trials);
  // From the share outwards, whose evidence against itself is below any bound.
  const auto end = [&](double outside) {
    double inside = hits == 0 ? -kFarthest : hits == trials ? kFarthest : sim::Log(k / (n - k));
    for (int i = 0; i < 60; ++i) {
      const double middle = (inside + outside) / 2.0;
      (Evidence(k, n, ProbabilityAt(middle)) < enough ? inside : outside) = middle;
    }
    return ProbabilityAt(outside);
  };
  return {hits == 0 ? 0.0 : end(-kFarthest), hits == trials ? 1.0 : end(kFarthest)};
}

double StudentQuantile(double probability, int degrees_of_freedom) {
  const double z = sim::NormalDeviate(probability);
  const double v = degrees_of_freedom;
  const double z2 = z * z;
  return z + z * (z2 + 1.0) / (4.0 * v) + z * ((5.0 * z2 + 16.0) * z2 + 3.0) / (96.0 * v * v) +
         z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / (384.0 * v * v * v);
}

}  // namespace gauntlet
