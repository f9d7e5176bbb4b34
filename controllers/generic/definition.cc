#include "controllers/generic/definition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "controllers/generic/formula.h"
#include "controllers/generic/measures.h"
#include "controllers/registry.h"
#include "sim/arena/color.h"
#include "sim/arena/validity.h"

namespace gauntlet::controllers::generic {
namespace {

constexpr double kFarthest = sim::kMaxArenaSide / 2.0;  // m from the arena's centre
constexpr std::string_view kColor = "color";            // a number inside, a name outside

struct FormulaKey {
  std::string_view name;
  const std::vector<std::string>& (*names)();  // that it may use
  bool required = true;
};
constexpr std::array kFormulas = std::to_array<FormulaKey>({
    {"fitness", NamesAtTheEnd},
    {"failure", NamesAtTheEnd},
    {"reached", NamesAtAMoment, false},
});

const ParameterTable<sim::Light>& LightKeys() {
  using L = sim::Light;
  static const ParameterTable<L> table({
      {"x", "m", 0, -kFarthest, kFarthest, {[](L& light, double v) { light.position.x() = v; }}, "place"},
      {"y", "m", 0, -kFarthest, kFarthest, {[](L& light, double v) { light.position.y() = v; }}, "place"},
      {"height", "m", 0.5, 0, 10, Into<&L::height>(), "above the floor"},
      {"intensity", "", 3, 0, 40, Into<&L::intensity>(),
       "ARGoS' intensity: seen up to 2.5 times as many metres away; 0 = no light sensor reads it"},
      {kColor, "", 0, 0, sim::kColorNames.size() - 1, Into<&L::color>(), "as cameras see it"},
  });
  return table;
}

// `grey`: where nothing is said.
ParameterTable<Area> AreaKeys(double grey) {
  using A = Area;
  return ParameterTable<A>({
      {"x", "m", 0, -kFarthest, kFarthest, Into<&A::x>(), "of its centre"},
      {"y", "m", 0, -kFarthest, kFarthest, Into<&A::y>(), "of its centre"},
      {"radius", "m", 0, 0, kFarthest, Into<&A::radius>(), "of a disc"},
      {"length", "m", 0, 0, sim::kMaxArenaSide, Into<&A::length>(), "of a rectangle, along x"},
      {"width", "m", 0, 0, sim::kMaxArenaSide, Into<&A::width>(), "of a rectangle, along y"},
      {"grey", "", grey, 0, 1, Into<&A::grey>(), "of the floor: 0 = black, 1 = white"},
  });
}

struct ElementTable {
  std::string_view name;
  std::span<const ParameterInfo> keys;
  // Appends the element with these resolved values.
  std::function<void(Definition&, const sim::Parameters&)> append;
};

template <auto Member, typename Element>
ElementTable TableOf(std::string_view name, const ParameterTable<Element>& keys) {
  return {name, keys.infos(), [&keys](Definition& definition, const sim::Parameters& values) {
            (definition.*Member).push_back(keys.Read(values));
          }};
}

// Greys of source and nest: those of ARGoS' foraging example.
const std::vector<ElementTable>& Tables() {
  static const ParameterTable<Area> ground = AreaKeys(0.0);
  static const ParameterTable<Area> source = AreaKeys(0.0);
  static const ParameterTable<Area> nest = AreaKeys(0.5);
  static const std::vector<ElementTable> tables = {
      TableOf<&Definition::lights>("light", LightKeys()), TableOf<&Definition::ground>("ground", ground),
      TableOf<&Definition::sources>("source", source), TableOf<&Definition::nests>("nest", nest)};
  return tables;
}

std::string Quoted(std::string_view text) {
  return std::string("\"").append(text).append("\"");
}

// As much of a text as fits into a message.
std::string Beginning(const std::string& text) {
  constexpr std::size_t kMost = 200;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

Error UnknownKey(std::string_view path) {
  std::vector<std::string_view> known;
  for (const FormulaKey& formula : kFormulas) known.push_back(formula.name);
  for (const ElementTable& table : Tables()) known.push_back(table.name);
  return InvalidInput("[generic]: " + UnknownName("key", path, known));
}

Result<double> ColorNumber(const DefinitionValue& value) {
  const auto* name = std::get_if<std::string>(&value);
  const std::optional<sim::Color> color = name == nullptr ? std::nullopt : sim::ColorNamed(*name);
  if (color) return static_cast<double>(*color);
  std::string known;
  for (const std::string_view one : sim::kColorNames) known.append(known.empty() ? "" : ", ").append(one);
  const std::string given = name == nullptr ? NumberText(std::get<double>(value)) : Quoted(*name);
  return InvalidInput("color = " + given + " is unknown, allowed " + known);
}

Status CheckArea(const sim::Parameters& area) {
  const double radius = area.at("radius");
  const double length = area.at("length");
  const double width = area.at("width");
  if (radius > 0.0 && length == 0.0 && width == 0.0) return Ok{};
  if (radius == 0.0 && length > 0.0 && width > 0.0) return Ok{};
  return InvalidInput("radius = " + NumberText(radius) + ", length = " + NumberText(length) + ", width = " +
                      NumberText(width) + ": a disc has a radius, a rectangle a length and a width, in m");
}

Error IsAList(std::string_view table) {
  const std::string name(table);
  return InvalidInput(name + " is a list: each of it begins with [[generic." + name + "]]");
}

struct ElementPath {
  const ElementTable* table = nullptr;
  int number = 0;  // from 1 on
};

// Of "light.1".
Result<ElementPath> ReadElementPath(std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string_view name = path.substr(0, dot);
  const ElementTable* table = FindByName(Tables(), name);
  if (table == nullptr) return UnknownKey(name);
  const std::optional<int> number =
      dot == std::string_view::npos ? std::nullopt : ParseNumber<int>(path.substr(dot + 1));
  if (!number) return IsAList(name);
  if (*number >= 1 && *number <= kMostElements) return ElementPath{table, *number};
  return InvalidInput(std::string(path) + ": a list has the places 1 to " + std::to_string(kMostElements));
}

// The value as the one parameter of that name.
Result<sim::Parameters> Given(std::span<const ParameterInfo> keys, const std::string& key,
                              const DefinitionValue& value) {
  if (FindByName(keys, key) == nullptr) return InvalidInput(UnknownName("key", key, keys));
  sim::Parameters given;
  if (key == kColor) {
    TRY(given[key], ColorNumber(value));
    return given;
  }
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr)
    return InvalidInput(key + " = " + Quoted(std::get<std::string>(value)) + ", expected a number");
  given[key] = *number;
  TRY(ResolveParameters(keys, given));
  return given;
}

std::string TextOf(const ParameterInfo& key, double value) {
  if (key.name == kColor) return std::string(sim::kColorNames.at(static_cast<std::size_t>(value)));
  return NumberText(value);
}

}  // namespace

bool Area::Holds(const sim::Vec2& point) const {
  const sim::Vec2 offset = point - sim::Vec2(x, y);
  if (radius > 0.0) return offset.squaredNorm() <= radius * radius;
  return std::abs(offset.x()) <= length / 2.0 && std::abs(offset.y()) <= width / 2.0;
}

sim::Vec2 Area::HalfExtents() const {
  return radius > 0.0 ? sim::Vec2(radius, radius) : sim::Vec2(length / 2.0, width / 2.0);
}

std::vector<DefinitionKey> DefinitionKeys() {
  std::vector<DefinitionKey> keys;
  for (const FormulaKey& formula : kFormulas)
    keys.push_back({.path = std::string(formula.name), .required = formula.required});
  for (const ElementTable& table : Tables()) {
    for (const ParameterInfo& key : table.keys) {
      keys.push_back({.path = std::string(table.name).append(".1.").append(key.name),
                      .number = &key,
                      .names = key.name == kColor ? std::span<const std::string_view>(sim::kColorNames)
                                                  : std::span<const std::string_view>()});
    }
  }
  return keys;
}

Status DefinitionReader::Set(std::string_view path, const DefinitionValue& value) {
  if (path.find('.') != std::string_view::npos) return SetInElement(path, value);
  const FormulaKey* key = FindByName(kFormulas, path);
  if (key == nullptr) return FindByName(Tables(), path) == nullptr ? UnknownKey(path) : IsAList(path);
  const auto* number = std::get_if<double>(&value);
  std::string text = number != nullptr ? NumberText(*number) : std::get<std::string>(value);
  if (key->required || !text.empty()) {
    const Result<Formula> formula = Formula::Compile(text, key->names());
    if (!formula.ok())
      return InvalidInput(std::string(path) + " = " + Quoted(Beginning(text)) + ": " +
                          formula.error().message);
  }
  formulas_.insert_or_assign(std::string(path), std::move(text));
  return Ok{};
}

Status DefinitionReader::Begin(std::string_view path) {
  TRY(const ElementPath element, ReadElementPath(path));
  elements_[element.table->name][element.number];
  return Ok{};
}

Status DefinitionReader::SetInElement(std::string_view path, const DefinitionValue& value) {
  const std::size_t dot = path.rfind('.');
  TRY(const ElementPath element, ReadElementPath(path.substr(0, dot)));
  const Result<sim::Parameters> given = Given(element.table->keys, std::string(path.substr(dot + 1)), value);
  if (!given.ok()) return InvalidInput(std::string(path.substr(0, dot)) + ": " + given.error().message);
  elements_[element.table->name][element.number].insert_or_assign(given->begin()->first,
                                                                  given->begin()->second);
  return Ok{};
}

Result<Definition> DefinitionReader::Finish() const {
  Definition definition;
  for (const FormulaKey& key : kFormulas) {
    if (!key.required || formulas_.contains(key.name)) continue;
    return InvalidInput(
        "[generic] " + std::string(key.name) + " is missing: a formula such as " +
        (key.name == "failure" ? "\"largest_cluster < 0.5 * robots\"" : "\"largest_cluster / robots\""));
  }
  const auto formula = [&](std::string_view name) {
    const auto found = formulas_.find(name);
    return found == formulas_.end() ? std::string() : found->second;
  };
  definition.fitness = formula("fitness");
  definition.failure = formula("failure");
  definition.reached = formula("reached");
  for (const auto& [name, elements] : elements_) {
    const ElementTable& table = *FindByName(Tables(), name);
    int expected = 1;
    for (const auto& [number, given] : elements) {
      const std::string what = std::string(name) + "." + std::to_string(number);
      if (number != expected++)
        return InvalidInput(what + " without " + std::string(name) + "." + std::to_string(expected - 1));
      const sim::Parameters values = *ResolveParameters(table.keys, given);
      if (values.contains("radius")) {
        if (const Status area = CheckArea(values); !area.ok())
          return InvalidInput(what + ": " + area.error().message);
      }
      table.append(definition, values);
    }
  }
  return definition;
}

Result<std::string> DefinitionReader::Text() const {
  TRY(Finish());
  std::string text;
  for (const FormulaKey& key : kFormulas) {
    const auto found = formulas_.find(key.name);
    if (found == formulas_.end() || found->second.empty()) continue;
    text.append(key.name).append(" = ").append(found->second).append("\n");
  }
  for (const ElementTable& table : Tables()) {
    const auto elements = elements_.find(table.name);
    if (elements == elements_.end()) continue;
    for (const auto& [number, given] : elements->second) {
      const sim::Parameters values = *ResolveParameters(table.keys, given);
      for (const ParameterInfo& key : table.keys) {
        text.append(table.name).append(".").append(std::to_string(number)).append(".").append(key.name);
        text.append(" = ").append(TextOf(key, values.at(std::string(key.name)))).append("\n");
      }
    }
  }
  return text;
}

Result<std::vector<DefinitionEntry>> EntriesOf(std::string_view text) {
  std::vector<DefinitionEntry> entries;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = line.find(" = ");
    if (equals == std::string_view::npos)
      return InvalidInput("the line " + Quoted(line) + " of a definition is no NAME = VALUE");
    const std::string path(line.substr(0, equals));
    const std::string value(line.substr(equals + 3));
    const std::optional<double> number = ParseNumber<double>(value);
    const bool formula = FindByName(kFormulas, path) != nullptr;
    entries.emplace_back(path, number && !formula ? DefinitionValue(*number) : DefinitionValue(value));
  }
  return entries;
}

Result<Definition> ParseDefinition(std::string_view text) {
  TRY(const std::vector<DefinitionEntry> entries, EntriesOf(text));
  DefinitionReader reader;
  for (const auto& [path, value] : entries) {
    TRY(reader.Set(path, value));
  }
  return reader.Finish();
}

}  // namespace gauntlet::controllers::generic
