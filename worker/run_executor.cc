#include "worker/run_executor.h"

#include "controllers/registry.h"
#include "proto/run_codec.h"
#include "sim/simulation.h"

namespace gauntlet::worker {

sim::RunResult Run(const sim::RunSpec& spec) {
  const auto scenario = controllers::CreateScenario(spec);
  if (!scenario.ok()) {
    sim::RunResult refused;
    refused.verdict = sim::Verdict::kRefused;
    refused.message = scenario.error().message;
    sim::SetHashes(refused);
    return refused;
  }
  return sim::Simulate(*scenario.value(), spec.seed, spec.record_trajectory,
                       {.physics = spec.physics, .disturbances = spec.disturbances});
}

sim::RunResult Rehearse() {
  const controllers::ControllerInfo& controller = controllers::Controllers().front();
  sim::RunSpec spec;
  spec.scenario = controller.scenario;
  spec.controller = controller.name;
  spec.scenario_parameters.emplace(controllers::FindScenario(controller.scenario)->time_limit, 1.0);
  const Result<sim::RunSpec> read = proto::DecodeRunSpec(proto::EncodeRunSpec(spec));
  GAUNTLET_CHECK(read.ok(), "a spec that does not decode");
  const Result<sim::RunResult> result = proto::DecodeRunResult(proto::EncodeRunResult(Run(*read)));
  GAUNTLET_CHECK(result.ok(), "a result that does not decode");
  return *result;
}

}  // namespace gauntlet::worker
