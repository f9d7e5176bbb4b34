// What a monitoring system wants of a living master, in Prometheus' text format
// (https://prometheus.io/docs/instrumenting/exposition_formats/, version 0.0.4).
#pragma once

#include <cstdint>
#include <string>

#include "master/campaign/campaign_status.h"
#include "master/dispatch/evaluation_backend.h"

namespace gauntlet {

// What the master process itself has used.
struct ProcessCost {
  double cpu_seconds = 0.0;  // user and system
  std::uint64_t resident_bytes = 0;
};
ProcessCost CostOfThisProcess();

// The metrics stand in docs/operations.md.
std::string MetricsText(const MasterView& master, const CampaignProgress& progress,
                        const BackendView& backend, const ProcessCost& cost);

}  // namespace gauntlet
