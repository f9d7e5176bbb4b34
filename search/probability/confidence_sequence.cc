#include "search/probability/confidence_sequence.h"

#include <algorithm>
#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr double kSpread =
    3.0;  // of the near alternatives; chosen so that no interval of 1e5 trials is twice as wide
constexpr double kNear = 0.9;       // their share
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

// The logarithm of the mean likelihood over alternatives with a beta distribution.
double LogLikelihood(double a, double b, double hits, double misses) {
  return LogGamma(a + hits) - LogGamma(a) + LogGamma(b + misses) - LogGamma(b) -
         LogGamma(a + b + hits + misses) + LogGamma(a + b);
}

// The logarithm of the mixture against p.
double Evidence(double hits, double trials, double p) {
  const double misses = trials - hits;
  const double of_p = hits * sim::Log(p) + misses * sim::Log(1.0 - p);
  const double near = LogLikelihood(kSpread / (1.0 - p), kSpread / p, hits, misses) - of_p;
  const double any = LogLikelihood(0.5, 0.5, hits, misses) - of_p;
  const double more = std::max(near, any);
  return more + sim::Log(kNear * sim::Exp(near - more) + (1.0 - kNear) * sim::Exp(any - more));
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
