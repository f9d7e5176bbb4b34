// Round numbers for an axis.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace gauntlet::analysis {

// The smallest of 1, 2 or 5 times a power of ten that divides `span` (above 0) into at most `most` parts.
inline double RoundStep(double span, int most) {
  const double power = std::pow(10.0, std::floor(std::log10(span / most)));
  constexpr double kSlack = 1.0 + 1e-9;  // of rounding
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (span <= factor * power * most * kSlack) return factor * power;
  }
  return 10.0 * power;
}

// The multiples of such a step within [low, high]; low < high.
inline std::vector<double> RoundValues(double low, double high, int most) {
  constexpr double kSlack = 1e-9;  // of rounding
  const double step = RoundStep(high - low, most);
  const double first = std::ceil(low / step - kSlack);
  const auto count = static_cast<int>(std::floor(high / step + kSlack) - first);
  std::vector<double> values;
  for (int i = 0; i <= count; ++i) values.push_back((first + i) * step);
  return values;
}

}  // namespace gauntlet::analysis
