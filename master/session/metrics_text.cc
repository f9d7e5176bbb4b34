#include "master/session/metrics_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/system/atomic_file.h"
#include "base/system/resource_limits.h"

namespace gauntlet {
namespace {

std::string Number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", value);
}

}  // namespace

ProcessCost CostOfThisProcess() {
  ProcessCost cost;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  cost.cpu_seconds = CpuSecondsOf(usage);
  // "size resident ...", in pages.
  if (const Result<std::string> statm = ReadSmallFile("/proc/self/statm"); statm) {
    const std::size_t space = statm->find(' ');
    if (space != std::string::npos) {
      cost.resident_bytes = std::strtoull(statm->c_str() + space, nullptr, 10) *
                            static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    }
  }
  return cost;
}

std::string MetricsText(std::vector<MetricSample> metrics, const ProcessCost& cost) {
  metrics.push_back({"process_cpu_seconds_total", "counter", "CPU time of the master, s.", cost.cpu_seconds});
  metrics.push_back({"process_resident_memory_bytes", "gauge", "Resident memory of the master.",
                     static_cast<double>(cost.resident_bytes)});
  std::string text;
  std::string_view described;
  for (const MetricSample& metric : metrics) {
    if (described != metric.name)
      text += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", metric.name, metric.help, metric.type);
    described = metric.name;
    text += fmt::format("{}{} {}\n", metric.name, metric.labels.empty() ? "" : "{" + metric.labels + "}",
                        Number(metric.value));
  }
  return text;
}

}  // namespace gauntlet
