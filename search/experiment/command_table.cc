#include "search/experiment/command_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/parse_number.h"
#include "base/printable.h"

namespace gauntlet {
namespace {

using nlohmann::json;

constexpr std::string_view kCommandTable = "command";
constexpr std::string_view kInCommand = "command.";

// Nothing of what no value of the table is.
std::optional<json> JsonOf(const TomlValue& value) {
  if (const auto* other = std::get_if<OtherToml>(&value)) {
    if (other->texts) return json(*other->texts);
    if (other->kind == kListOfTables || other->kind == "a table") return json::object();
    return std::nullopt;
  }
  return std::visit(
      [](const auto& held) -> std::optional<json> {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, OtherToml>)
          return std::nullopt;
        else
          return json(held);
      },
      value);
}

// Puts a value at its place, "metric.2.name". Error: an element of a list without those before it, or a table
// where a value stands.
Status Put(json& table, std::string_view path, json value) {
  json* place = &table;
  std::string_view rest = path;
  while (true) {
    const std::size_t dot = rest.find('.');
    const std::string name(rest.substr(0, dot));
    const auto number = ParseNumber<std::size_t>(name);
    if (number && place->is_object() && place->empty()) *place = json::array();
    if (place->is_array()) {
      if (!number || *number < 1 || *number > place->size() + 1)
        return InvalidInput(
            fmt::format("{}{}: the elements of a list are numbered 1, 2, 3, ...", kInCommand, path));
      if (*number == place->size() + 1) place->push_back(json::object());
      place = &(*place)[*number - 1];
    } else if (place->is_object()) {
      place = &(*place)[name];
      if (place->is_null()) *place = json::object();
    } else {
      return InvalidInput(fmt::format("{}{}: a value stands where a table is meant", kInCommand, path));
    }
    if (dot == std::string_view::npos) break;
    rest.remove_prefix(dot + 1);
  }
  const bool begins = value.is_object() && value.empty();
  if (!begins || !(place->is_object() || place->is_array())) *place = std::move(value);
  return Ok{};
}

// Where the key of a complaint stands: the assignment of its path, or else the last one below or above it.
std::string PlaceOf(std::span<const Assignment> assignments, const std::string& path,
                    const std::string& file_name) {
  std::string place = file_name;
  std::size_t best = 0;
  for (const Assignment& assignment : assignments) {
    if (!assignment.path.starts_with(kInCommand)) continue;
    const std::string_view own = std::string_view(assignment.path).substr(kInCommand.size());
    const bool near = path == own || path.starts_with(std::string(own) + ".") || own.starts_with(path + ".");
    if (near && own.size() >= best) {
      best = own.size();
      place = assignment.where;
    }
  }
  return place;
}

}  // namespace

std::vector<KeyInfo> CommandKeys() {
  std::vector<KeyInfo> keys = controllers::command::Keys();
  for (KeyInfo& key : keys) key.path = std::string(kInCommand) + key.path;
  return keys;
}

bool InCommand(std::string_view path) {
  return path == kCommandTable || path.starts_with(kInCommand);
}

Result<std::optional<controllers::command::Definition>> ReadCommand(const ExperimentText& experiment,
                                                                    const std::vector<std::string>& sets) {
  Result<std::vector<Assignment>> assignments = ReadToml(experiment.text, experiment.file_name);
  if (!assignments) return Printable(assignments.error());
  if (std::ranges::none_of(*assignments, InCommand, &Assignment::path))
    return std::optional<controllers::command::Definition>();
  for (const std::string& set : sets) {
    Result<Assignment> assignment = ReadSet(set);
    if (!assignment) return Printable(assignment.error());
    assignments->push_back(std::move(*assignment));
  }
  json table = json::object();
  for (const Assignment& assignment : *assignments) {
    if (!assignment.path.starts_with(kInCommand)) continue;
    std::optional<json> value = JsonOf(assignment.value);
    const std::string& where = assignment.where;
    if (!value)
      return InvalidInput(
          fmt::format("{}: {} is {}, expected a number, text, true or false, or a list of texts", where,
                      assignment.path, KindOf(assignment.value)));
    if (const Status put =
            Put(table, std::string_view(assignment.path).substr(kInCommand.size()), std::move(*value));
        !put)
      return Printable(InvalidInput(fmt::format("{}: {}", where, put.error().message)));
  }
  controllers::command::ReadDefinition read = controllers::command::Read(table);
  if (!read.complaint) return std::optional(std::move(read.definition));
  return Printable(InvalidInput(fmt::format(
      "{}: {}", PlaceOf(*assignments, read.complaint->path, experiment.file_name), read.complaint->what)));
}

}  // namespace gauntlet
