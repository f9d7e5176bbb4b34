// One table of what can be tested: scenarios and controllers by name, each parameter with its unit, default
// and range. A runner builds the scenario of a run; the master does so only to see how its swarm begins
// (controllers/run_start.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "controllers/behaviour.h"
#include "sim/run_spec.h"
#include "sim/run_start.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

std::span<const ScenarioInfo> Scenarios();
std::span<const ControllerInfo> Controllers();  // those that are built in

// What a plug-in brings, as this process knows it: a runner that has loaded the library can run it, a master
// that was told of it knows names, parameters, metrics and the like.
struct PluginInfo {
  std::string hash;  // SHA-256 of the library, 64 hexadecimal digits
  std::string file;  // where it is
  // A campaign or a study, which somebody else may have made, has brought it along. Else the user named it.
  bool brought_along = false;
  // In a master: what gauntlet-worker said of it, from which the rows come (controllers/rows/plugin_rows.h).
  std::string description = {};
  std::vector<ControllerInfo> controllers;
  std::vector<ScenarioInfo> scenarios = {};  // in a master without the functions of their rows
  // In a master: how a run in one of its scenarios begins, as a process answers that loads the library.
  // Error: why that gives no answer. nullptr: the rows say it.
  std::function<Result<sim::RunBeginning>(const sim::RunSpec& spec)> begin = nullptr;
};
// Makes it known for the rest of this process' life; one that is known already stays as it is. What the rows
// refer to is never freed. Error: one of its controllers or scenarios has the name of a built-in one.
Status AddPlugin(PluginInfo plugin);
const PluginInfo* FindPlugin(std::string_view hash);  // nullptr when it is not known
// The user has named a file with the library of this known plug-in.
void NamePlugin(std::string_view hash, const std::string& file);

// nullptr when there is none of that name. `plugin`: the hash of the plug-in to look in; "": those built in.
const ScenarioInfo* FindScenario(std::string_view name, std::string_view plugin = "");
const ControllerInfo* FindController(std::string_view name, std::string_view plugin = "");
// The one that the settings name; nullptr when there is none, or its plug-in is not known here.
const ScenarioInfo* FindScenario(const sim::RunSettings& settings);
const ControllerInfo* FindController(const sim::RunSettings& settings);
// FindScenario, or a row that declares nothing.
const ScenarioInfo& DeclaredScenario(const sim::RunSettings& settings);

// The settings' scenario. Error: there is none of that name, or its plug-in is not known here.
Result<const ScenarioInfo*> ScenarioOf(const sim::RunSettings& settings);

// The metric `name` of a scenario, or the family it belongs to; nullptr when the scenario reports none such.
const MetricInfo* FindMetric(const ScenarioInfo& scenario, std::string_view name);

// Defaults overridden by `given`. Error: unknown name (with the nearest known one), value out of range or not
// whole.
Result<sim::Parameters> ResolveParameters(std::span<const ParameterInfo> infos, const sim::Parameters& given);

// What judges the spec's run beyond its scenario; nothing where the spec requires nothing. Errors: as
// RunJudge::Make's.
Result<sim::Judge> JudgeOf(const sim::RunSpec& spec);

// Checks names, parameters and the arena, then builds the scenario. Error: the message begins with the broken
// rule's name and a colon when the test case is at fault.
Result<std::unique_ptr<sim::Scenario>> CreateScenario(const sim::RunSpec& spec);

// Whether the parameter is true or false.
inline bool IsFlag(const ParameterInfo& info) {
  return info.unit == "bool";
}

// The parameter's number in the type of its key.
inline KeyValue KeyValueOf(const ParameterInfo& info, double value) {
  if (IsFlag(info)) return value != 0.0;
  if (info.integer) return static_cast<std::int64_t>(value);
  return value;
}

// The key `beginning` and the parameter's name.
inline KeyInfo KeyInfoOf(const std::string& beginning, const ParameterInfo& info) {
  KeyInfo key;
  key.path = beginning + std::string(info.name);
  key.type = IsFlag(info) ? KeyType::kFlag : info.integer ? KeyType::kInteger : KeyType::kNumber;
  key.unit = IsFlag(info) ? "" : info.unit;
  key.min = info.min;
  key.max = info.max;
  key.description = info.description;
  key.default_value = KeyValueOf(info, info.default_value);
  return key;
}

}  // namespace gauntlet::controllers
