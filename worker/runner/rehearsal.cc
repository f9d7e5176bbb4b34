#include "worker/runner/rehearsal.h"

#include "base/check.h"
#include "controllers/registry.h"
#include "proto/run_codec.h"
#include "worker/run_executor.h"

namespace gauntlet::worker {

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
