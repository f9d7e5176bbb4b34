#include "worker/run_executor.h"

#include "controllers/registry.h"
#include "sim/simulation.h"

namespace gauntlet::worker {

namespace {

sim::RunResult Refused(const Error& error) {
  sim::RunResult refused;
  refused.verdict = sim::Verdict::kRefused;
  refused.message = error.message;
  sim::SetHashes(refused);
  return refused;
}

}  // namespace

sim::RunResult Run(const sim::RunSpec& spec) {
  const auto scenario = controllers::CreateScenario(spec);
  if (!scenario.ok()) return Refused(scenario.error());
  const auto judge = controllers::JudgeOf(spec);
  if (!judge.ok()) return Refused(judge.error());
  return sim::Simulate(*scenario.value(), spec.seed, spec.record_trajectory,
                       {.physics = spec.physics,
                        .disturbances = spec.disturbances,
                        .count_contacts = spec.count_contacts,
                        .judge = *judge});
}

}  // namespace gauntlet::worker
