#include "search/experiment/definition_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/split.h"
#include "controllers/generic/definition.h"
#include "controllers/registry.h"
#include "controllers/requirements/requirements.h"
#include "search/experiment/schema.h"
#include "search/experiment/varied_keys.h"

namespace gauntlet {
namespace {

using controllers::generic::DefinitionEntry;
using controllers::generic::DefinitionReader;

constexpr std::string_view kTable = "generic";
constexpr std::string_view kBegin = "generic.";

// Nothing of what no value of a definition is.
std::optional<KeyValue> DefinitionOf(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

Status Set(const Assignment& assignment, DefinitionReader& reader) {
  const std::string_view path = std::string_view(assignment.path).substr(kBegin.size());
  const auto* other = std::get_if<OtherToml>(&assignment.value);
  const bool begins = other != nullptr && other->kind == kListOfTables;
  const std::optional<KeyValue> value = begins ? KeyValue(0.0) : DefinitionOf(assignment.value);
  if (!value) {
    return InvalidInput(fmt::format("{}: {} is {}, expected a number or text", assignment.where,
                                    assignment.path, KindOf(assignment.value)));
  }
  const Status set = begins ? reader.Begin(path) : reader.Set(path, *value);
  if (!set.ok()) return InvalidInput(fmt::format("{}: {}", assignment.where, set.error().message));
  return Ok{};
}

using controllers::requirements::kFailure;
using controllers::requirements::kStep;
using controllers::requirements::Requirements;

constexpr std::string_view kBeginRequirements = "requirements.";
constexpr std::string_view kBeginConditions = "conditions.";

struct Entry {
  std::string name;
  std::string formula;
  std::string where;

  int Rank() const { return name == kStep ? 0 : name == kFailure ? 2 : 1; }
};

// Of a table whose names stand behind `begin`; the later of one name wins, and what is "" is taken back.
Result<std::vector<Entry>> EntriesIn(std::span<const Assignment> assignments, std::string_view begin,
                                     std::string_view expected) {
  std::vector<Entry> entries;
  for (const Assignment& assignment : assignments) {
    if (!assignment.path.starts_with(begin)) continue;
    const auto* formula = std::get_if<std::string>(&assignment.value);
    if (formula == nullptr && assignment.text.empty())
      return InvalidInput(fmt::format("{}: {} is {}, expected {} as text", assignment.where, assignment.path,
                                      KindOf(assignment.value), expected));
    Entry entry{assignment.path.substr(begin.size()), formula == nullptr ? assignment.text : *formula,
                assignment.where};
    std::ranges::replace_if(
        entry.formula, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    const auto before = std::ranges::find(entries, entry.name, &Entry::name);
    if (before == entries.end()) {
      entries.push_back(std::move(entry));
    } else {
      *before = std::move(entry);
    }
  }
  std::erase_if(entries, [](const Entry& entry) { return entry.formula.empty(); });
  return entries;
}

}  // namespace

std::vector<KeyInfo> DefinitionKeys() {
  std::vector<KeyInfo> keys = controllers::generic::DefinitionKeys();
  for (KeyInfo& key : keys) key.path = std::string(kBegin) + key.path;
  return keys;
}

bool InDefinition(std::string_view path) {
  return path == kTable || path.starts_with(kBegin);
}

Result<std::string> ReadDefinition(std::span<const Assignment> assignments, const std::string& file_name) {
  DefinitionReader reader;
  for (const Assignment& assignment : assignments) {
    if (!assignment.path.starts_with(kBegin)) continue;
    TRY(Set(assignment, reader));
  }
  Result<std::string> text = reader.Text();
  if (!text.ok()) return InvalidInput(fmt::format("{}: {}", file_name, text.error().message));
  return text;
}

std::string WriteDefinition(const std::string& definition) {
  if (definition.empty()) return "";
  std::string text = "\n[generic]\n";
  std::string last_element;
  const std::vector<DefinitionEntry> entries = *controllers::generic::EntriesOf(definition);
  for (const auto& [path, value] : entries) {
    const std::size_t dot = path.rfind('.');
    const std::string element = path.substr(0, dot == std::string::npos ? 0 : dot);
    if (element != last_element)
      text += fmt::format("\n[[generic.{}]]\n", element.substr(0, element.find('.')));
    last_element = element;
    const std::string key = path.substr(element.empty() ? 0 : dot + 1);
    text += fmt::format("{} = {}\n", key, ToToml(value));
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> DefinitionSettings(const std::string& definition) {
  std::vector<std::pair<std::string, std::string>> settings;
  const std::vector<DefinitionEntry> entries = *controllers::generic::EntriesOf(definition);
  for (const auto& [path, value] : entries) {
    const auto* number = std::get_if<double>(&value);
    settings.emplace_back(std::string(kBegin) + path,
                          number != nullptr ? NumberText(*number) : std::get<std::string>(value));
  }
  return settings;
}

bool InRequirements(std::string_view path) {
  return path.starts_with(kBeginRequirements);
}

Result<std::string> ReadRequirements(std::span<const Assignment> assignments, const std::string& file_name,
                                     const std::vector<controllers::MetricInfo>& metrics) {
  TRY(std::vector<Entry> entries, EntriesIn(assignments, kBeginRequirements, "a formula"));
  if (entries.empty()) return std::string();
  std::ranges::stable_sort(entries, {}, &Entry::Rank);
  Requirements requirements(metrics);
  std::string text;
  for (const Entry& entry : entries) {
    if (const Status added = requirements.Add(entry.name, entry.formula); !added)
      return InvalidInput(fmt::format("{}: {}", entry.where, added.error().message));
    text += fmt::format("{} = {}\n", entry.name, entry.formula);
  }
  if (const Status whole = requirements.Check(); !whole)
    return InvalidInput(fmt::format("{}: {}", file_name, whole.error().message));
  return text;
}

std::vector<std::string> WindowsBeyondTheRun(const Experiment& experiment) {
  const controllers::ScenarioInfo* scenario =
      controllers::FindScenario(experiment.scenario, experiment.scenario_plugin);
  if (scenario == nullptr) return {};
  const auto requirements = Requirements::Parse(experiment.requirements, scenario->metrics);
  if (!requirements) return {};
  return requirements->BeyondTheRun(scenario->TimeLimit(experiment.scenario_parameters));
}

std::string WriteRequirements(const std::string& requirements) {
  std::string text;
  for (const auto& [name, formula] : controllers::requirements::EntriesOf(requirements))
    text += fmt::format("{}{} = {}\n", text.empty() ? "\n[requirements]\n" : "", name, QuoteToml(formula));
  return text;
}

std::vector<std::pair<std::string, std::string>> RequirementSettings(const std::string& requirements) {
  std::vector<std::pair<std::string, std::string>> settings =
      controllers::requirements::EntriesOf(requirements);
  for (auto& [name, formula] : settings) name.insert(0, kBeginRequirements);
  return settings;
}

bool InConditions(std::string_view path) {
  return path.starts_with(kBeginConditions);
}

Result<std::string> ReadConditions(std::span<const Assignment> assignments, std::span<const Key> keys,
                                   const Experiment& experiment) {
  TRY(std::vector<Entry> entries,
      EntriesIn(assignments, kBeginConditions, "a distribution such as \"0..0.2\""));
  std::string text;
  for (Entry& entry : entries) {
    std::erase(entry.formula, ' ');
    const auto varied = ParseVariedKeys({entry.name + "=" + entry.formula}, keys, experiment, Varied::kDrawn);
    if (!varied) return InvalidInput(fmt::format("{}: {}", entry.where, varied.error().message));
    text += (text.empty() ? "" : " ") + varied->front().ToText();
  }
  return text;
}

std::string WriteConditions(const std::string& conditions) {
  std::string text;
  for (const std::string& one : WordsOf(conditions)) {
    const std::size_t equals = one.find('=');
    text += fmt::format("{}{} = {}\n", text.empty() ? "\n[conditions]\n" : "", one.substr(0, equals),
                        QuoteToml(one.substr(equals + 1)));
  }
  return text;
}

}  // namespace gauntlet
