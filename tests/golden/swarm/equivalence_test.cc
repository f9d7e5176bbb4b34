#include "tests/golden/swarm/equivalence_test.h"

#include <cmath>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/sample.h"
#include "base/check.h"

namespace gauntlet::analysis {

EquivalenceTest TestEquivalence(std::span<const double> differences, double margin, double alpha) {
  GAUNTLET_CHECK(differences.size() >= 2, "equivalence needs at least two differences");
  GAUNTLET_CHECK(margin > 0.0 && alpha > 0.0 && alpha < 0.5, "margin and alpha must be positive");
  const double n = static_cast<double>(differences.size());
  EquivalenceTest test;
  const Description description = Describe(differences);
  test.mean = description.mean;
  test.sd = description.sd.value();

  const double error = test.sd / std::sqrt(n);
  const double half = StudentUpperQuantile(alpha, n - 1.0) * error;
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
