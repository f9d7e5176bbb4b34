// What a monitoring system wants of a living master, in Prometheus' text format
// (https://prometheus.io/docs/instrumenting/exposition_formats/, version 0.0.4).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "master/campaign/campaign_status.h"

namespace gauntlet {

// What the master process itself has used.
struct ProcessCost {
  double cpu_seconds = 0.0;  // user and system
  std::uint64_t resident_bytes = 0;
};
ProcessCost CostOfThisProcess();

// The campaign's metrics (StatusMetrics), and those of the process.
std::string MetricsText(std::vector<MetricSample> metrics, const ProcessCost& cost);

}  // namespace gauntlet
