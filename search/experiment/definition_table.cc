#include "search/experiment/definition_table.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "controllers/generic/definition.h"
#include "search/experiment/schema.h"

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

}  // namespace gauntlet
