// gauntlet list: what can be named, and every parameter with unit, default and range.
#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "controllers/registry.h"
#include "master/cli/commands.h"
#include "master/cli/table.h"
#include "master/experiment/experiment_file.h"
#include "master/experiment/schema.h"
#include "master/search/search_table.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTextWidth = 110;

struct ListOptions {
  std::string section;  // the name of one of kSections, "" = all
  bool json = false;
};

// What the search reads, keys of searches first.
std::vector<Key> KeysOf(const SearchInfo& search) {
  std::vector<Key> keys = CommonKeys(BuiltInCatalogue());
  std::erase_if(keys, [&](const Key& key) { return !Reads(search, key.path); });
  std::ranges::stable_partition(keys, [](const Key& key) { return key.path.starts_with("search."); });
  return keys;
}

std::string Number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string RangeOf(double min, double max) {
  return fmt::format("{} to {}", Number(min), Number(max));
}

std::string RangeOf(const Key& key) {
  if (key.type == KeyType::kChoice) return "a choice";
  if (key.type == KeyType::kFlag) return "true, false";
  if (key.type == KeyType::kText) return "text";
  return RangeOf(key.min, key.max);
}

std::string DescriptionOf(const Key& key) {
  if (key.type != KeyType::kChoice) return key.description;
  return fmt::format("{} ({})", fmt::join(key.choices, " | "), key.description);
}

std::string DefaultOf(const Key& key) {
  const auto* text = std::get_if<std::string>(&key.default_value);
  return text != nullptr ? *text : ToToml(key.default_value);
}

std::vector<Table::Column> ParameterColumns() {
  return {{"parameter", Align::kLeft},
          {"default", Align::kRight},
          {"unit", Align::kLeft},
          {"range", Align::kLeft},
          {"", Align::kLeft}};
}

std::string ParameterTable(std::span<const controllers::ParameterInfo> parameters) {
  Table table(ParameterColumns());
  for (const controllers::ParameterInfo& info : parameters) {
    table.AddRow({std::string(info.name), Number(info.default_value), std::string(info.unit),
                  RangeOf(info.min, info.max), std::string(info.description)});
  }
  return table.ToText(4);
}

std::string MetricTable(std::span<const controllers::MetricInfo> metrics) {
  Table table({{"metric", Align::kLeft}, {"unit", Align::kLeft}, {"", Align::kLeft}});
  for (const controllers::MetricInfo& info : metrics) {
    table.AddRow({std::string(info.name), std::string(info.unit),
                  fmt::format("{}{}{}", info.description, info.may_be_none ? "; -1 = none" : "",
                              info.descriptor ? "; describes behaviour" : "")});
  }
  return table.ToText(4);
}

std::string FailureTable(std::span<const controllers::FailureType> failures) {
  if (failures.empty()) return {};
  Table table({{"failure type", Align::kRight}, {"", Align::kLeft}});
  for (const controllers::FailureType& failure : failures) {
    table.AddRow({fmt::format("{}", failure.type), failure.name});
  }
  return "\n" + table.ToText(4);
}

std::string ExperimentsText() {
  Table table({{"", Align::kLeft}, {"", Align::kLeft}});
  for (const ShippedExperiment& shipped : ListExperiments(BuiltInCatalogue())) {
    table.AddRow({shipped.name, shipped.error.empty() ? shipped.description : "ERROR: " + shipped.error});
  }
  return "Experiments (gauntlet evolve NAME)\n" + table.ToText();
}

std::string ScenariosText() {
  std::string text = "Scenarios (--set scenario=NAME, --set scenario_parameters.PARAMETER=VALUE)\n";
  for (const controllers::ScenarioInfo& scenario : controllers::Scenarios()) {
    text +=
        "\n  " + Wrapped(fmt::format("{}: {}", scenario.name, scenario.description), kTextWidth, 4) + "\n";
    text += fmt::format("    controller unless another is named: {}\n\n", scenario.default_controller);
    text += ParameterTable(scenario.parameters) + "\n" + MetricTable(scenario.metrics) +
            FailureTable(scenario.failure_types);
  }
  return text;
}

std::string ControllersText() {
  std::string text = "Controllers (--set controller=NAME, --set controller_parameters.PARAMETER=VALUE)\n";
  for (const controllers::ControllerInfo& controller : controllers::Controllers()) {
    text += "\n  " + Wrapped(fmt::format("{}: {}", controller.name, controller.description), kTextWidth, 4) +
            "\n";
    text += fmt::format("    written for the scenario {}\n\n", controller.scenario);
    text += ParameterTable(controller.parameters);
  }
  return text;
}

std::string SearchesText() {
  std::string text = "Searches (--set search.algorithm=NAME, --set PARAMETER=VALUE)\n";
  for (const SearchInfo& search : BuiltInCatalogue().searches) {
    text += fmt::format("\n  {}: {}\n\n", search.name, search.description);
    Table table(ParameterColumns());
    for (const Key& key : KeysOf(search)) {
      table.AddRow({key.path, DefaultOf(key), key.unit, RangeOf(key), DescriptionOf(key)});
    }
    text += table.ToText(4);
  }
  return text;
}

std::string DisturbancesText() {
  Table table(ParameterColumns());
  for (const Key& key : CommonKeys(BuiltInCatalogue())) {
    if (!IsDisturbance(key)) continue;
    table.AddRow({key.path, DefaultOf(key), key.unit, RangeOf(key), DescriptionOf(key)});
  }
  return "Disturbances (--set PARAMETER=VALUE on any experiment)\n\n" + table.ToText();
}

Json ParametersJson(std::span<const controllers::ParameterInfo> parameters) {
  Json list = Json::array();
  for (const controllers::ParameterInfo& info : parameters) {
    list.push_back({{"name", info.name},
                    {"type", info.unit == "bool" ? "flag"
                             : info.integer      ? "integer"
                                                 : "number"},
                    {"unit", info.unit == "bool" ? "" : info.unit},
                    {"default", info.default_value},
                    {"min", info.min},
                    {"max", info.max},
                    {"description", info.description}});
  }
  return list;
}

Json MetricsJson(std::span<const controllers::MetricInfo> metrics) {
  Json list = Json::array();
  for (const controllers::MetricInfo& info : metrics) {
    list.push_back({{"name", info.name},
                    {"unit", info.unit},
                    {"may_be_none", info.may_be_none},
                    {"descriptor", info.descriptor},
                    {"description", info.description}});
  }
  return list;
}

Json FailuresJson(std::span<const controllers::FailureType> failures) {
  Json list = Json::array();
  for (const auto& [type, name] : failures) list.push_back({{"type", type}, {"name", name}});
  return list;
}

Json KeyJson(const Key& key) {
  Json json = {{"name", key.path}, {"type", NameOf(key.type)}, {"unit", key.unit}};
  std::visit(
      [&](const auto& value) {
        // Seeds are strings: readers of JSON lose digits of numbers above 2^53.
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::uint64_t>) {
          json["default"] = fmt::format("{}", value);
        } else {
          json["default"] = value;
        }
      },
      key.default_value);
  if (key.type == KeyType::kChoice) {
    json["choices"] = key.choices;
  } else if (key.type == KeyType::kInteger || key.type == KeyType::kNumber) {
    json["min"] = key.min;
    json["max"] = key.max;
  }
  json["description"] = key.description;
  return json;
}

Json ExperimentsJson() {
  Json list = Json::array();
  for (const ShippedExperiment& shipped : ListExperiments(BuiltInCatalogue())) {
    list.push_back({{"name", shipped.name},
                    {"description", shipped.description},
                    {"scenario", shipped.scenario},
                    {"controller", shipped.controller},
                    {"path", shipped.path.string()},
                    {"error", shipped.error.empty() ? Json(nullptr) : Json(shipped.error)}});
  }
  return list;
}

Json ScenariosJson() {
  Json list = Json::array();
  for (const controllers::ScenarioInfo& scenario : controllers::Scenarios()) {
    list.push_back({{"name", scenario.name},
                    {"description", scenario.description},
                    {"default_controller", scenario.default_controller},
                    {"parameters", ParametersJson(scenario.parameters)},
                    {"time_limit", scenario.time_limit},
                    {"metrics", MetricsJson(scenario.metrics)},
                    {"failure_types", FailuresJson(scenario.failure_types)}});
  }
  return list;
}

Json ControllersJson() {
  Json list = Json::array();
  for (const controllers::ControllerInfo& controller : controllers::Controllers()) {
    list.push_back({{"name", controller.name},
                    {"description", controller.description},
                    {"scenario", controller.scenario},
                    {"parameters", ParametersJson(controller.parameters)}});
  }
  return list;
}

Json SearchesJson() {
  Json list = Json::array();
  for (const SearchInfo& search : BuiltInCatalogue().searches) {
    Json parameters = Json::array();
    for (const Key& key : KeysOf(search)) parameters.push_back(KeyJson(key));
    list.push_back(
        {{"name", search.name}, {"description", search.description}, {"parameters", std::move(parameters)}});
  }
  return list;
}

Json DisturbancesJson() {
  Json list = Json::array();
  for (const Key& key : CommonKeys(BuiltInCatalogue())) {
    if (IsDisturbance(key)) list.push_back(KeyJson(key));
  }
  return list;
}

struct Section {
  const char* name;
  std::string (*text)();
  Json (*json)();
};
constexpr Section kSections[] = {{"experiments", ExperimentsText, ExperimentsJson},
                                 {"scenarios", ScenariosText, ScenariosJson},
                                 {"controllers", ControllersText, ControllersJson},
                                 {"searches", SearchesText, SearchesJson},
                                 {"disturbances", DisturbancesText, DisturbancesJson}};

ExitCode RunList(CommandContext& context, const ListOptions& options) {
  std::string text;
  Json json = Json::object();
  for (const Section& section : kSections) {
    if (!options.section.empty() && section.name != options.section) continue;
    if (options.json) {
      json[section.name] = section.json();
    } else {
      text += (text.empty() ? "" : "\n") + section.text();
    }
  }
  if (options.json) text = JsonText(json);
  context.out << text << std::flush;
  return kExitDone;
}

}  // namespace

void AddList(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "list", "experiments, scenarios, controllers, searches, disturbances; all parameters", RunList);
  std::vector<std::string> names;
  for (const Section& section : kSections) names.emplace_back(section.name);
  command
      .add_option("SECTION", options.section,
                  "experiments, scenarios, controllers, searches or disturbances (default: all)")
      ->check(CLI::IsMember(names));
  command.add_flag("--json", options.json, "as one JSON document");
  command.footer(R"(Examples:
  gauntlet list experiments
  gauntlet list controllers --json | jq '.controllers[].name')");
}

}  // namespace gauntlet::master
