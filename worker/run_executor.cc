#include "worker/run_executor.h"

#include "controllers/registry.h"
#include "sim/simulation.h"

namespace gauntlet::worker {

sim::RunResult Run(const sim::RunSpec& spec) {
  const auto scenario = controllers::CreateScenario(spec);
  const auto judge = controllers::JudgeOf(spec);
  if (!scenario.ok() || !judge.ok()) {
    sim::RunResult refused;
    refused.verdict = sim::Verdict::kRefused;
    refused.message = (scenario.ok() ? judge.error() : scenario.error()).message;
    sim::SetHashes(refused);
    return refused;
  }
  return sim::Simulate(*scenario.value(), spec.seed, spec.record_trajectory,
                       {.physics = spec.physics,
                        .disturbances = spec.disturbances,
                        .count_contacts = spec.count_contacts,
                        .judge = *judge});
}

}  // namespace gauntlet::worker
