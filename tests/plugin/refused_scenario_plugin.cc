// Scenarios that must be refused, one for each definition that tests/plugin/CMakeLists.txt makes.
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sdk/plugin.h"

namespace {

namespace sim = gauntlet::sim;
namespace controllers = gauntlet::controllers;
using controllers::ScenarioInfo;

struct Settings {
  sim::Tick tick_limit = 0;
};

const std::vector<controllers::MetricInfo> kMetrics = {{"count", "", {}, "of nothing"}};

std::vector<ScenarioInfo> Rows() {
  static const controllers::ParameterTable<Settings> table(
      {{"time_limit", "s", 1, 1, 60, controllers::IntoTicks<&Settings::tick_limit>(), "length of a run"}});
  ScenarioInfo row{.name = "refused",
                   .description = "is refused",
                   .default_controller = "light-flocking",
                   .parameters = table.infos(),
                   .metrics = kMetrics,
                   .any_controller = true};
  row.requirements = [](const sim::Parameters&, const sim::TestCase&) { return sim::ArenaRequirements{}; };
  row.create = [](const sim::RunSpec&, const controllers::ControllerFactory&) {
    return std::unique_ptr<sim::Scenario>();
  };
#if defined(BUILT_IN_SCENARIO)
  row.name = "flocking";
#elif defined(TAKEN_SCENARIO)
  row.name = "sound";  // of plugin_of_faulty_scenarios
#elif defined(TWO_SCENARIOS_OF_ONE_NAME)
  return {row, row};
#elif defined(NO_SUCH_TIME_LIMIT)
  row.time_limit = "seconds";
#elif defined(NO_SUCH_METRIC)
  row.failures.axes = {{"counts", 0.0, 1.0, 2}};
#elif defined(FAILS_WITHOUT_A_METRIC)
  row.failing = "count";
#elif defined(WITHOUT_REQUIREMENTS)
  row.requirements = nullptr;
#elif defined(WITH_PASSAGES)
  row.failures.passages = [](const sim::Parameters&, const sim::TestCase&) {
    return std::vector<sim::Vec2>();
  };
#elif defined(THROWS_IN_SCENARIOS)
  throw std::runtime_error("no scenarios today");
#endif
  return {row};
}

}  // namespace

GAUNTLET_SCENARIO_PLUGIN(nullptr, Rows)
