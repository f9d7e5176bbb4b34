#include "worker/golden_hash.h"

#include <algorithm>
#include <vector>

#include "base/hash.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"
#include "worker/run_executor.h"

namespace gauntlet::worker {
namespace {

constexpr double kRunSeconds = 40.0;

// An empty arena; one with boxes right before the start, so that robots touch them and lose sight of each
// other; one with boxes everywhere. All of them are valid for every scenario.
std::vector<sim::TestCase> Cases() {
  std::vector<sim::TestCase> cases(3);
  cases[1].obstacles = {{1.6, 1.7, 0.9, 0.2, 30.0}, {2.2, 1.4, 0.4, 0.3, 117.0}, {1.2, 2.4, 0.6, 0.1, 250.0}};
  cases[2].obstacles = {{-1.1, 0.3, 1.3, 0.2, 71.0},
                        {1.3, 0.6, 1.1, 0.4, 164.0},
                        {0.2, 1.3, 1.7, 0.1, 45.0},
                        {1.8, 1.9, 0.5, 0.3, 12.0},
                        {0.9, -0.7, 0.8, 0.2, 301.0}};
  return cases;
}

void AddRuns(const controllers::ControllerInfo& controller, Fnv1a64& hash) {
  // One for any scenario runs in the first.
  const controllers::ScenarioInfo* own = controllers::FindScenario(controller.scenario);
  const controllers::ScenarioInfo& scenario = own != nullptr ? *own : controllers::Scenarios().front();
  const std::vector<sim::TestCase> cases = Cases();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    sim::RunSpec spec;
    spec.test_case = cases[i];
    spec.scenario = scenario.name;
    spec.controller = controller.name;
    spec.seed = 1000 + i;
    spec.scenario_parameters.emplace(scenario.time_limit, kRunSeconds);
    const sim::RunResult result = Run(spec);
    hash.AddUint64(static_cast<std::uint64_t>(result.verdict));
    hash.AddUint64(result.hash);
  }
}

void AddArithmetic(Fnv1a64& hash) {
  for (int i = -200; i <= 200; ++i) {
    const double x = 0.37 * i;
    const sim::SinCos sine_cosine = sim::SineCosine(x);
    hash.AddDouble(sine_cosine.sin);
    hash.AddDouble(sine_cosine.cos);
    hash.AddDouble(sim::Atan2(x, 1.3 + 0.01 * i));
    hash.AddDouble(sim::WrapAngle(x));
    hash.AddDouble(sim::Exp(0.1 * x));
    hash.AddDouble(sim::Log(80.0 + x));
  }
  sim::RandomStream random(1, sim::StreamPurpose::kTest, 2, 3);
  for (int i = 0; i < 100; ++i) {
    hash.AddUint64(random.NextUint64());
    hash.AddDouble(random.Uniform());
    hash.AddDouble(random.Gaussian());
  }
}

}  // namespace

std::uint64_t GoldenHashOf(const controllers::ControllerInfo& controller) {
  Fnv1a64 hash;
  AddArithmetic(hash);
  hash.AddBytes(controller.name);  // two controllers may do the same in runs as short as these
  AddRuns(controller, hash);
  return hash.value();
}

proto::GoldenHashes GoldenHashes(const std::vector<std::string>& controllers) {
  proto::GoldenHashes hashes;
  for (const controllers::ControllerInfo& controller : controllers::Controllers()) {
    if (!controllers.empty() && std::ranges::find(controllers, controller.name) == controllers.end())
      continue;
    hashes.emplace(controller.name, GoldenHashOf(controller));
  }
  return hashes;
}

}  // namespace gauntlet::worker
