// gauntlet list: what can be named, and every parameter with unit, default and range.
#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/nearest_name.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "controllers/command/definition.h"
#include "controllers/registry.h"
#include "controllers/requirements/measures.h"
#include "controllers/rows/row_json.h"
#include "master/directory/plugins.h"
#include "proto/json_text.h"
#include "search/experiment/command_table.h"
#include "search/experiment/definition_table.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/schema.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTextWidth = 110;

struct ListOptions {
  std::string section;  // the name of one of kSections, "" = all
  std::string name;     // of a scenario, of which all is told; "" = none
  bool json = false;
  std::vector<std::string> plugins;  // libraries: what they bring, and nothing else
};

// What the search reads, keys of searches first.
std::vector<Key> KeysOf(const SearchInfo& search) {
  std::vector<Key> keys = BuiltInKeys();
  std::erase_if(keys, [&](const Key& key) { return !Reads(search, key.path); });
  std::stable_partition(keys.begin(), keys.end(),
                        [](const Key& key) { return key.path.starts_with("search."); });
  return keys;
}

std::vector<Key> DisturbanceKeys() {
  std::vector<Key> keys = BuiltInKeys();
  std::erase_if(keys, std::not_fn(&Key::disturbs));
  return keys;
}

std::string Number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string RangeOf(const KeyInfo& key) {
  if (key.type == KeyType::kChoice) return "a choice";
  if (key.type == KeyType::kFlag) return "true, false";
  if (key.type == KeyType::kText) return "text";
  return fmt::format("{} to {}", Number(key.min), Number(key.max));
}

std::string DescriptionOf(const KeyInfo& key) {
  if (key.type != KeyType::kChoice) return key.description;
  return fmt::format("{} ({})", fmt::join(key.choices, " | "), key.description);
}

std::string DefaultOf(const KeyInfo& key) {
  const auto* number = std::get_if<double>(&key.default_value);
  return number != nullptr ? Number(*number) : ToSet(key.default_value);
}

template <typename Keys>
std::string KeyTable(const Keys& keys, std::size_t indent) {
  Table table({"parameter", ">default", "unit", "range", ""});
  for (const KeyInfo& key : keys)
    table.AddRow({key.path, DefaultOf(key), key.unit, RangeOf(key), DescriptionOf(key)});
  return table.ToText(indent);
}

std::string ParameterTable(std::span<const controllers::ParameterInfo> parameters) {
  std::vector<KeyInfo> keys;
  for (const controllers::ParameterInfo& info : parameters) keys.push_back(controllers::KeyInfoOf("", info));
  return KeyTable(keys, 4);
}

// What an experiment may define of a scenario that is defined by it.
std::string DefinitionText() {
  return "\n" + KeyTable(DefinitionKeys(), 4) +
         "\n    Formulas are over the metrics below. Of light, ground, source and nest there may be "
         "several:\n"
         "    generic.light.2.x, or in a file one [[generic.light]] after the other.\n";
}

std::string MetricTable(std::span<const controllers::MetricInfo> metrics) {
  Table table({"metric", "unit", ""});
  for (const controllers::MetricInfo& info : metrics) {
    table.AddRow(
        {std::string(info.name), std::string(info.unit),
         fmt::format("{}{}{}", info.description, info.none ? fmt::format("; {} = none", *info.none) : "",
                     info.descriptor ? "; describes behaviour" : "")});
  }
  return table.ToText(4);
}

std::string FailureTable(std::span<const controllers::FailureType> failures) {
  if (failures.empty()) return {};
  Table table({">failure type", ""});
  for (const controllers::FailureType& failure : failures) {
    table.AddRow({fmt::format("{}", failure.type), failure.name});
  }
  return "\n" + table.ToText(4);
}

std::string ExperimentsText() {
  Table table({"", ""});
  for (const ShippedExperiment& shipped : ListExperiments(BuiltInCatalogue())) {
    table.AddRow({shipped.name, shipped.error.empty() ? shipped.description : "ERROR: " + shipped.error});
  }
  return "Experiments (gauntlet evolve NAME)\n" + table.ToText();
}

std::string RowsText(std::span<const controllers::ScenarioInfo> rows) {
  std::string text;
  for (const controllers::ScenarioInfo& scenario : rows) {
    text +=
        "\n  " + Wrapped(fmt::format("{}: {}", scenario.name, scenario.description), kTextWidth, 4) + "\n";
    text += fmt::format("    controller unless another is named: {}\n\n", scenario.default_controller);
    text += ParameterTable(scenario.parameters) + (scenario.check_definition ? DefinitionText() : "") + "\n" +
            MetricTable(scenario.metrics) + FailureTable(scenario.failure_types.types);
  }
  return text;
}

// What an experiment may say of a program of the user's.
std::string CommandText() {
  return "\n  command: a program of yours simulates the runs (docs/any-simulator.md)\n\n" +
         KeyTable(CommandKeys(), 4) +
         "\n    Of metric, parameter, point, keep_out, standing, axis and refused there may be several: in a "
         "file\n"
         "    one [[command.metric]] after the other.\n";
}

constexpr const char* kScenariosTitle =
    "Scenarios (--set scenario=NAME, --set scenario_parameters.PARAMETER=VALUE)\n";

// What to begin with in a scenario: the shipped experiment of its name, else the first one of it.
std::string FirstCommand(std::string_view scenario) {
  std::string first;
  for (const ShippedExperiment& shipped : ListExperiments(BuiltInCatalogue())) {
    if (shipped.scenario == scenario && (first.empty() || shipped.name == scenario)) first = shipped.name;
  }
  return first.empty() ? "" : "gauntlet evolve " + first;
}

std::string ScenariosText() {
  return kScenariosTitle + RowsText(controllers::Scenarios()) + CommandText();
}

std::string ScenariosOverview() {
  Table table({"scenario", "begin with", "what it is"});
  for (const controllers::ScenarioInfo& scenario : controllers::Scenarios())
    table.AddRow({scenario.name, FirstCommand(scenario.name), scenario.description});
  table.AddRow(
      {"command", "gauntlet adopt FOLDER", "a program of yours simulates the runs (docs/any-simulator.md)"});
  return kScenariosTitle + table.ToText() +
         "\n  New here? Begin with 'gauntlet evolve flocking'. 'gauntlet list scenarios NAME' names the "
         "parameters,\n"
         "  metrics and types of failure of one scenario.\n";
}

// All that is known of one scenario.
Result<std::string> ScenarioText(const std::string& name) {
  if (name == controllers::command::kScenario) return kScenariosTitle + CommandText();
  const auto& rows = controllers::Scenarios();
  const controllers::ScenarioInfo* row = FindByName(rows, name);
  if (row == nullptr) return InvalidInput(UnknownName("scenario", name, rows));
  return kScenariosTitle + RowsText(std::span(row, 1));
}

std::string RowsText(std::span<const controllers::ControllerInfo> rows) {
  std::string text;
  for (const controllers::ControllerInfo& controller : rows) {
    text += "\n  " + Wrapped(fmt::format("{}: {}", controller.name, controller.description), kTextWidth, 4) +
            "\n";
    text += controller.scenario == controllers::kAnyScenario
                ? "    written for any scenario\n\n"
                : fmt::format("    written for the scenario {}\n\n", controller.scenario);
    text += ParameterTable(controller.parameters);
  }
  return text;
}

std::string ControllersText() {
  return "Controllers (--set controller=NAME, --set controller_parameters.PARAMETER=VALUE)\n" +
         RowsText(controllers::Controllers());
}

std::string PluginText(const controllers::PluginInfo& plugin) {
  std::string text;
  const auto add = [&](std::string_view what, std::string_view key, const std::string& rows) {
    if (rows.empty()) return;
    text += fmt::format("{}{} of {} (--plugin {} --set {}=NAME), SHA-256 {}\n", text.empty() ? "" : "\n",
                        what, plugin.file, PastedPath(plugin.file), key, plugin.hash) +
            rows;
  };
  add("Scenarios", "scenario", RowsText(plugin.scenarios));
  add("Controllers", "controller", RowsText(plugin.controllers));
  return text;
}

std::string SearchesText() {
  std::string text = "Searches (--set search.algorithm=NAME, --set PARAMETER=VALUE)\n";
  for (const SearchInfo& search : BuiltInCatalogue().searches) {
    text += fmt::format("\n  {}: {}\n\n", search.name, search.description);
    text += KeyTable(KeysOf(search), 4);
  }
  return text;
}

std::string DisturbancesText() {
  return "Disturbances (--set PARAMETER=VALUE on any experiment)\n\n" + KeyTable(DisturbanceKeys(), 2);
}

std::string MeasuresText() {
  Table table({"measure", "of", "unit", "range", ""});
  for (const controllers::requirements::MeasureRow& row : controllers::requirements::MeasureRows())
    table.AddRow({std::string(row.name), row.per_robot ? "each robot" : "the swarm", std::string(row.unit),
                  std::string(row.range), std::string(row.description)});
  return "Measures (--set requirements.NAME=FORMULA, docs/requirements.md)\n\n" + table.ToText();
}

// What `to_json` makes of each item.
template <typename Items>
Json ListOf(const Items& items, const auto& to_json) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(to_json(item));
  return list;
}

Json KeyJson(const KeyInfo& key) {
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

Json ExperimentJson(const ShippedExperiment& shipped) {
  return {{"name", shipped.name},          {"description", shipped.description},
          {"scenario", shipped.scenario},  {"controller", shipped.controller},
          {"path", shipped.path.string()}, {"error", shipped.error.empty() ? Json() : Json(shipped.error)}};
}

// Of a scenario or a controller.
constexpr auto RowJson = [](const auto& row) { return controllers::JsonOf(row); };

Json PluginJson(const controllers::PluginInfo& plugin) {
  return {{"file", plugin.file},
          {"sha256", plugin.hash},
          {"scenarios", ListOf(plugin.scenarios, RowJson)},
          {"controllers", ListOf(plugin.controllers, RowJson)}};
}

Json SearchJson(const SearchInfo& search) {
  return {{"name", search.name},
          {"description", search.description},
          {"parameters", ListOf(KeysOf(search), KeyJson)}};
}

struct Listing {
  const char* name;
  std::string (*text)();
  Json (*json)();
  std::string (*overview)() = nullptr;  // printed instead of the text where nothing else is asked for
};
Json MeasureJson(const controllers::requirements::MeasureRow& row) {
  return {{"name", row.name},
          {"per_robot", row.per_robot},
          {"unit", row.unit},
          {"range", row.range},
          {"description", row.description}};
}

constexpr Listing kSections[] = {
    {"experiments", ExperimentsText,
     [] { return ListOf(ListExperiments(BuiltInCatalogue()), ExperimentJson); }},
    {"scenarios", ScenariosText, [] { return ListOf(controllers::Scenarios(), RowJson); }, ScenariosOverview},
    {"controllers", ControllersText, [] { return ListOf(controllers::Controllers(), RowJson); }},
    {"searches", SearchesText, [] { return ListOf(BuiltInCatalogue().searches, SearchJson); }},
    {"disturbances", DisturbancesText, [] { return ListOf(DisturbanceKeys(), KeyJson); }},
    {"measures", MeasuresText, [] { return ListOf(controllers::requirements::MeasureRows(), MeasureJson); }}};

Result<ExitCode> ListPlugins(CommandContext& context, const ListOptions& options) {
  TRY(const std::vector<std::string> plugins, AddPluginFiles(options.plugins));
  std::string text;
  Json json = Json::array();
  for (const std::string& hash : plugins) {
    const controllers::PluginInfo& plugin = *controllers::FindPlugin(hash);
    text += (text.empty() ? "" : "\n") + PluginText(plugin);
    json.push_back(PluginJson(plugin));
  }
  context.out << (options.json ? JsonText({{"plugins", std::move(json)}}) : text) << std::flush;
  return kExitDone;
}

Result<ExitCode> RunList(CommandContext& context, const ListOptions& options) {
  if (!options.plugins.empty()) return ListPlugins(context, options);
  if (!options.name.empty()) {
    if (options.section != "scenarios" || options.json)
      return InvalidInput("list: a name is taken behind 'scenarios' only, and without --json");
    TRY(const std::string text, ScenarioText(options.name));
    context.out << text << std::flush;
    return kExitDone;
  }
  std::string text;
  Json json = Json::object();
  for (const Listing& section : kSections) {
    if (!options.section.empty() && section.name != options.section) continue;
    if (options.json) {
      json[section.name] = section.json();
    } else {
      const bool alone = !options.section.empty() && section.overview != nullptr;
      text += (text.empty() ? "" : "\n") + (alone ? section.overview() : section.text());
    }
  }
  if (options.json) text = JsonText(json);
  context.out << text << std::flush;
  return kExitDone;
}

}  // namespace

void AddList(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "list", "list experiments, scenarios, controllers, searches, disturbances, measures and all parameters",
      RunList);
  std::vector<std::string> names;
  for (const Listing& section : kSections) names.emplace_back(section.name);
  auto* section = command
                      .add_option("SECTION", options.section,
                                  "the section to print: experiments, scenarios, controllers, searches, "
                                  "disturbances or measures (default: all)")
                      ->check(CLI::IsMember(names));
  command.add_option("NAME", options.name, "of a scenario: all its parameters, metrics and types of failure")
      ->needs(section);
  AddValue(command, "--plugin", "LIB.so", options.plugins, "list what this library of yours brings instead");
  command.get_option("--plugin")->excludes(section);
  command.add_flag("--json", options.json, "print the list as one JSON document");
  command.footer(R"(Examples:
  gauntlet list experiments
  gauntlet list scenarios
  gauntlet list scenarios flocking
  gauntlet list --plugin build/libmine.so
  gauntlet list controllers --json | jq '.controllers[].name')");
}

}  // namespace gauntlet
