// Scenarios that misbehave, each in one of its functions, and `sound`, which does not.
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sdk/plugin.h"

namespace {

namespace sim = gauntlet::sim;
namespace controllers = gauntlet::controllers;

struct Settings {
  sim::Tick tick_limit = 0;
};

void Crash() {
  volatile int* nowhere = nullptr;
  *nowhere = 1;
}

// What happens at a place of a scenario that has this fault, "exit-in-swarm".
void Misbehave(std::string_view fault, std::string_view place) {
  if (!fault.ends_with(place)) return;
  if (fault.starts_with("crash")) Crash();
  if (fault.starts_with("exit")) std::exit(0);
  if (fault.starts_with("throw")) throw std::runtime_error("not today");
  for (volatile bool on = fault.starts_with("spin"); on;) continue;
}

class Faulty : public sim::Scenario {
 public:
  Faulty(std::string_view fault, const sim::TestCase& test_case, const Settings& settings,
         controllers::ControllerFactory robots)
      : fault_(fault), arena_(test_case), settings_(settings), robots_(std::move(robots)) {
    Misbehave(fault_, "in-constructor");
  }
  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }
  gauntlet::Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters&) override {
    Misbehave(fault_, "in-swarm");
    std::vector<sim::RobotSetup> swarm;
    if (fault_ == "without-robots") return swarm;
    swarm.push_back({.pose = {}, .controller = robots_.create({.robot = 0})});
    return swarm;
  }
  void Interact(const sim::Interaction&) override { Misbehave(fault_, "in-tick"); }
  bool Finished(const sim::Observer&) override { return false; }
  sim::Outcome Evaluate(const sim::Observer&) override {
    Misbehave(fault_, "in-evaluate");
    sim::Outcome outcome;
    outcome.fitness = 0.5;
    outcome.lost.assign(1, false);
    return outcome;
  }

 private:
  std::string_view fault_;
  sim::Arena arena_;
  Settings settings_;
  controllers::ControllerFactory robots_;
};

controllers::ScenarioInfo Row(std::string_view fault) {
  static const controllers::ParameterTable<Settings> table(
      {{"time_limit", "s", 1, 1, 60, controllers::IntoTicks<&Settings::tick_limit>(), "length of a run"}});
  controllers::ScenarioInfo row{.name = std::string(fault),
                                .description = "misbehaves",
                                .default_controller = "light-flocking",
                                .parameters = table.infos(),
                                .metrics = {},
                                .any_controller = true};
  row.requirements = [fault](const sim::Parameters&, const sim::TestCase& test_case) {
    Misbehave(fault, "in-requirements");
    const double nowhere = fault == "start-outside" ? 1e9 : 0.0;
    // What stands in the arena does not count, also for a scenario that looks at it.
    const double shift = static_cast<double>(test_case.obstacles.size());
    return sim::ArenaRequirements{.start = {nowhere + shift, 0.0}, .goal = {-1.0, 0.0}};
  };
  row.create = [fault](const sim::RunSpec& spec, controllers::ControllerFactory robots) {
    return std::make_unique<Faulty>(fault, spec.test_case, table.Read(spec.scenario_parameters),
                                    std::move(robots));
  };
  return row;
}

std::vector<controllers::ScenarioInfo> Rows() {
  return {Row("sound"),
          Row("crash-in-constructor"),
          Row("exit-in-constructor"),
          Row("throw-in-requirements"),
          Row("spin-in-requirements"),
          Row("crash-in-swarm"),
          Row("throw-in-swarm"),
          Row("throw-in-tick"),
          Row("crash-in-evaluate"),
          Row("exit-in-evaluate"),
          Row("spin-in-evaluate"),
          Row("throw-in-evaluate"),
          Row("without-robots"),
          Row("start-outside")};
}

}  // namespace

GAUNTLET_SCENARIO_PLUGIN(nullptr, Rows)
