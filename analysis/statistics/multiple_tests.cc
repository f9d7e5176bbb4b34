#include "analysis/statistics/multiple_tests.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"

namespace gauntlet::analysis {

std::vector<double> HolmAdjusted(std::span<const double> p) {
  for (const double one : p) GAUNTLET_CHECK(one >= 0.0 && one <= 1.0, "a p-value lies between 0 and 1");
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace gauntlet::analysis
