#include "analysis/statistics/equivalence_test.h"

#include <cmath>

#include "base/check.h"

namespace gauntlet::analysis {
namespace {

// The continued fraction of the incomplete beta function (Abramowitz and Stegun 26.5.8), by Lentz' method.
double BetaFraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMaxTerms = 500;
  const auto guarded = [](double value) { return std::fabs(value) < kTiny ? kTiny : value; };
  double c = 1.0;
  double d = 1.0 / guarded(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m <= kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 / guarded(1.0 + term * d);
      c = guarded(1.0 + term / c);
      step = c * d;
      fraction *= step;
    }
    if (std::fabs(step - 1.0) < 1e-15) break;
  }
  return fraction;
}

double RegularizedBeta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * BetaFraction(a, b, x) / a
                                       : 1.0 - front * BetaFraction(b, a, 1.0 - x) / b;
}

// The t whose upper tail is `p` < 0.5.
double StudentQuantile(double p, double degrees_of_freedom) {
  double low = 0.0;
  double high = 1.0;
  while (StudentUpperTail(high, degrees_of_freedom) > p && high < 1e12) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2.0;
    (StudentUpperTail(middle, degrees_of_freedom) > p ? low : high) = middle;
  }
  return (low + high) / 2.0;
}

}  // namespace

double StudentUpperTail(double t, double degrees_of_freedom) {
  const double x = degrees_of_freedom / (degrees_of_freedom + t * t);
  const double tail = RegularizedBeta(degrees_of_freedom / 2.0, 0.5, x) / 2.0;
  return t >= 0.0 ? tail : 1.0 - tail;
}

EquivalenceTest TestEquivalence(std::span<const double> differences, double margin, double alpha) {
  GAUNTLET_CHECK(differences.size() >= 2, "equivalence needs at least two differences");
  GAUNTLET_CHECK(margin > 0.0 && alpha > 0.0 && alpha < 0.5, "margin and alpha must be positive");
  const double n = static_cast<double>(differences.size());
  EquivalenceTest test;
  for (const double difference : differences) test.mean += difference / n;
  double squares = 0.0;
  for (const double difference : differences) squares += (difference - test.mean) * (difference - test.mean);
  test.sd = std::sqrt(squares / (n - 1.0));

  const double error = test.sd / std::sqrt(n);
  const double half = StudentQuantile(alpha, n - 1.0) * error;
  test.interval = {test.mean - half, test.mean + half};
  const double room = margin - std::fabs(test.mean);
  if (error > 0.0) {
    test.p = StudentUpperTail(room / error, n - 1.0);
  } else {
    test.p = room > 0.0 ? 0.0 : 1.0;
  }
  test.equivalent = test.p < alpha;
  return test;
}

}  // namespace gauntlet::analysis
