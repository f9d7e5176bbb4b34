#include "study/questions/corpus_experiment.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "base/printable.h"
#include "controllers/registry.h"
#include "search/experiment/definition_table.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

// What the last of the sets gives the key; "" when none does.
std::string SetValue(const std::vector<std::string>& sets, const std::string& key) {
  std::string value;
  for (const std::string& set : sets) {
    if (set.starts_with(key + "=")) value = set.substr(key.size() + 1);
  }
  return value;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> SettingsOf(const Experiment& experiment) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const Key& key : BuiltInKeys()) {
    const bool always = key.path == "scenario" || key.path == "controller" || key.path == "physics";
    if (always || (key.disturbs && key.get(experiment) != key.default_value))
      settings.emplace_back(key.path, ToSet(key.get(experiment)));
  }
  const auto add = [&](const std::string& table, const sim::Parameters& parameters) {
    for (const auto& [name, value] : parameters)
      settings.emplace_back(table + "." + name, fmt::format("{}", value));
  };
  add("scenario_parameters", experiment.scenario_parameters);
  add("controller_parameters", experiment.controller_parameters);
  std::ranges::move(DefinitionSettings(experiment.definition), std::back_inserter(settings));
  std::ranges::move(RequirementSettings(experiment.requirements), std::back_inserter(settings));
  return settings;
}

Result<Experiment> ExperimentOf(const CorpusEntry& entry, const std::vector<std::string>& sets,
                                const std::vector<std::string>& plugins) {
  const std::string scenario = SettingOf(entry.content, "scenario");
  if (const std::string other = SetValue(sets, "scenario"); !other.empty() && other != scenario) {
    return InvalidInput(Printable(fmt::format("--set scenario={}: the corpus is for the scenario '{}' ({})",
                                              other, scenario, entry.file)));
  }
  const std::string controller = SetValue(sets, "controller");
  const bool other_controller = !controller.empty() && controller != SettingOf(entry.content, "controller");
  const controllers::ControllerInfo* info = controllers::FindController(controller);
  const controllers::ScenarioInfo* tested = controllers::FindScenario(scenario);
  for (const std::string& plugin : plugins) {
    if (tested == nullptr) tested = controllers::FindScenario(scenario, plugin);
  }
  if (info != nullptr && tested != nullptr && !tested->Takes(*info)) {
    return InvalidInput(Printable(
        fmt::format("--set controller={}: it is written for the scenario '{}', the corpus is for '{}' ({})",
                    controller, info->scenario, scenario, entry.file)));
  }
  std::vector<std::string> all;
  for (const auto& [key, value] : entry.content.settings) {
    if (other_controller && key.starts_with("controller_parameters.")) continue;
    if (key == "controller" && other_controller) continue;
    all.push_back(fmt::format("{}={}", key, value));
  }
  const std::size_t from_file = all.size();
  all.insert(all.end(), sets.begin(), sets.end());
  Catalogue catalogue = BuiltInCatalogue();
  catalogue.plugins = plugins;
  Result<Experiment> experiment = ParseExperiment("", entry.file, all, catalogue);
  if (!experiment) {
    Error error = experiment.error();
    for (std::size_t i = 0; i < from_file; ++i) {  // what stands in the file was not typed
      const std::string typed = "--set " + all[i] + ":";
      if (error.message.starts_with(typed))
        error.message =
            fmt::format("{}: experiment.{}:{}", entry.file, all[i], error.message.substr(typed.size()));
    }
    const std::string named = controller.empty() ? SettingOf(entry.content, "controller") : controller;
    if (plugins.empty() && (tested == nullptr || controllers::FindController(named) == nullptr))
      error.message +=
          "; --plugin LIB.so names the library of one that a plug-in brings, --plugin NAME.toml the "
          "experiment "
          "of one that a program simulates";
    return error;
  }
  experiment->name = "check";
  experiment->description.clear();
  if (const auto refusal = RefusalOf(*experiment, entry.content.document.test_case)) {
    return InvalidInput(
        Printable(fmt::format("{}: its case breaks the rule {}: {}", entry.file,
                              refusal->rule.empty() ? "of its swarm" : refusal->rule, refusal->message)));
  }
  return experiment;
}

}  // namespace gauntlet
