#include "analysis/statistics/distributions.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "base/check.h"

namespace gauntlet::analysis {

namespace math = boost::math;

double NormalUpperTail(double z) {
  return math::cdf(math::complement(math::normal(), z));
}

double NormalQuantile(double probability) {
  GAUNTLET_CHECK(probability > 0.0 && probability < 1.0, "a normal quantile needs a probability in (0, 1)");
  return math::quantile(math::normal(), probability);
}

double StudentUpperTail(double t, double degrees_of_freedom) {
  GAUNTLET_CHECK(degrees_of_freedom > 0.0, "Student's distribution needs degrees of freedom > 0");
  return math::cdf(math::complement(math::students_t(degrees_of_freedom), t));
}

double StudentUpperQuantile(double tail, double degrees_of_freedom) {
  GAUNTLET_CHECK(degrees_of_freedom > 0.0, "Student's distribution needs degrees of freedom > 0");
  GAUNTLET_CHECK(tail > 0.0 && tail < 1.0, "Student's quantile needs a tail in (0, 1)");
  return math::quantile(math::complement(math::students_t(degrees_of_freedom), tail));
}

}  // namespace gauntlet::analysis
