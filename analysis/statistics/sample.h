// A set of measured values: whether statistics can be computed from it, its mean and spread, its quantiles
// and its box plot.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/statistics/interval.h"
#include "base/result.h"

namespace gauntlet::analysis {

// Every function of this folder takes values that pass this: at least one, all finite. The error names the
// set and the first value that is wrong, counted from 1.
Status CheckSample(std::span<const double> values, std::string_view name);

struct Description {
  std::size_t n = 0;
  double mean = 0.0;
  std::optional<double> sd;  // with n - 1; a single value has none
  double minimum = 0.0;
  double median = 0.0;
  double maximum = 0.0;
};
Description Describe(std::span<const double> values);

// Of the mean of at least two values, by Student's t distribution; confidence in (0, 1).
Interval MeanInterval(std::span<const double> values, double confidence);

// Type 7 of Hyndman and Fan 1996, the default of R and NumPy. `probability` in [0, 1]; the values in any
// order.
double Quantile(std::span<const double> values, double probability);

inline constexpr std::string_view kBoxRule =
    "Tukey's hinges; whiskers to the last value within 1.5 box lengths";
// R's boxplot.stats: the quartiles are Tukey's hinges, the medians of the halves, the median in both when n
// is odd.
struct BoxPlot {
  double lower_whisker = 0.0;  // the smallest value that is not more than 1.5 box lengths below the box
  double lower_quartile = 0.0;
  double median = 0.0;
  double upper_quartile = 0.0;
  double upper_whisker = 0.0;
  double lower_notch = 0.0;  // median -+ 1.58 box lengths / sqrt(n) (McGill, Tukey and Larsen 1978)
  double upper_notch = 0.0;
  std::vector<double> outliers;  // what lies beyond the whiskers, ascending
};
BoxPlot MakeBoxPlot(std::span<const double> values);

}  // namespace gauntlet::analysis
