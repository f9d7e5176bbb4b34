// What work costs in this process.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gauntlet::perf {

inline double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// CPU time in s.
template <typename Work>
double Cost(const Work& work) {
  const double before = CpuSeconds();
  work();
  return CpuSeconds() - before;
}

// The upper one of an even number of values.
inline double Median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace gauntlet::perf
