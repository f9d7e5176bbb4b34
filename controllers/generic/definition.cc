#include "controllers/generic/definition.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "controllers/generic/formula.h"
#include "controllers/generic/measures.h"
#include "sim/arena/color.h"
#include "sim/arena/validity.h"

namespace gauntlet::controllers::generic {
namespace {

using DefinitionKey = SettingsKey<Definition>;

constexpr double kFarthest = sim::kMaxArenaSide / 2.0;  // m from the arena's centre

// As much of a text as fits into a message.
std::string Beginning(const std::string& text) {
  constexpr std::size_t kMost = 200;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

// `names`: that it may use.
template <auto Member>
DefinitionKey FormulaKey(const std::string& path, const std::vector<std::string>& (*names)(), bool required) {
  DefinitionKey key = FieldKey<Definition, Member>(path, required ? "formula; must be given" : "formula");
  key.check = [=](const KeyValue& value) -> std::optional<std::string> {
    const auto& text = std::get<std::string>(value);
    if (!required && text.empty()) return std::nullopt;
    const Result<Formula> formula = Formula::Compile(text, names());
    if (formula.ok()) return std::nullopt;
    return path + " = " + QuoteToml(Beginning(text)) + ": " + formula.error().message;
  };
  return key;
}

const std::vector<DefinitionKey>& Formulas() {
  static const std::vector<DefinitionKey> keys = {
      FormulaKey<&Definition::fitness>("fitness", NamesAtTheEnd, true),
      FormulaKey<&Definition::failure>("failure", NamesAtTheEnd, true),
      FormulaKey<&Definition::reached>("reached", NamesAtAMoment, false)};
  return keys;
}

// `axis`: 0 = x, 1 = y.
SettingsKey<sim::Light> PlaceKey(const std::string& path, int axis) {
  SettingsKey<sim::Light> key;
  key.path = path;
  key.unit = "m";
  key.min = -kFarthest;
  key.max = kFarthest;
  key.description = "place";
  key.get = [axis](const sim::Light& light) -> KeyValue { return light.position[axis]; };
  key.set = [axis](sim::Light& light, const KeyValue& value) {
    light.position[axis] = std::get<double>(value);
  };
  return key;
}

std::vector<SettingsKey<sim::Light>> LightKeys() {
  using L = sim::Light;
  return {PlaceKey("x", 0), PlaceKey("y", 1),
          NumberKey<L, &L::height>("height", "m", 0, 10, "above the floor"),
          NumberKey<L, &L::intensity>(
              "intensity", "", 0, 40,
              "ARGoS' intensity: seen up to 2.5 times as many metres away; 0 = no light sensor reads it"),
          ChoiceKey<L, &L::color>("color", {sim::kColorNames.begin(), sim::kColorNames.end()},
                                  "as cameras see it")};
}

std::vector<SettingsKey<Area>> AreaKeys() {
  using A = Area;
  return {NumberKey<A, &A::x>("x", "m", -kFarthest, kFarthest, "of its centre"),
          NumberKey<A, &A::y>("y", "m", -kFarthest, kFarthest, "of its centre"),
          NumberKey<A, &A::radius>("radius", "m", 0, kFarthest, "of a disc"),
          NumberKey<A, &A::length>("length", "m", 0, sim::kMaxArenaSide, "of a rectangle, along x"),
          NumberKey<A, &A::width>("width", "m", 0, sim::kMaxArenaSide, "of a rectangle, along y"),
          NumberKey<A, &A::grey>("grey", "", 0, 1, "of the floor: 0 = black, 1 = white")};
}

struct List {
  std::string name;
  std::function<std::size_t(const Definition&)> size;
  std::function<void(Definition&, std::size_t)> grow;  // to at least this size
  // Of the element of that number, from 1 on, which is there when they are used.
  std::function<std::vector<DefinitionKey>(std::size_t)> keys;
};

// `start`: an element of which nothing is said.
template <typename Element>
List ListOf(const std::string& name, std::vector<Element> Definition::*member, const Element& start,
            const std::vector<SettingsKey<Element>>& keys) {
  List list;
  list.name = name;
  list.size = [=](const Definition& definition) { return (definition.*member).size(); };
  list.grow = [=](Definition& definition, std::size_t size) {
    (definition.*member).resize(std::max((definition.*member).size(), size), start);
  };
  list.keys = [=](std::size_t number) {
    std::vector<DefinitionKey> all;
    for (const SettingsKey<Element>& key : keys) {
      DefinitionKey& one = all.emplace_back();
      static_cast<KeyInfo&>(one) = key;
      one.path = name + "." + std::to_string(number) + "." + key.path;
      one.default_value = key.get(start);
      one.get = [=](const Definition& definition) { return key.get((definition.*member)[number - 1]); };
      one.set = [=](Definition& definition, const KeyValue& value) {
        key.set((definition.*member)[number - 1], value);
      };
    }
    return all;
  };
  return list;
}

// Greys of source and nest: those of ARGoS' foraging example; intensity: of its lights.
const std::vector<List>& Lists() {
  static const std::vector<List> lists = {
      ListOf("light", &Definition::lights, {.intensity = 3.0}, LightKeys()),
      ListOf("ground", &Definition::ground, {}, AreaKeys()),
      ListOf("source", &Definition::sources, {}, AreaKeys()),
      ListOf("nest", &Definition::nests, {.grey = 0.5}, AreaKeys())};
  return lists;
}

Error UnknownKey(std::string_view path) {
  std::vector<std::string_view> known;
  for (const DefinitionKey& formula : Formulas()) known.push_back(formula.path);
  for (const List& list : Lists()) known.push_back(list.name);
  return InvalidInput("[generic]: " + UnknownName("key", path, known));
}

Status CheckArea(const std::string& path, const Area& area) {
  const bool disc = area.radius > 0.0 && area.length == 0.0 && area.width == 0.0;
  if (disc || (area.radius == 0.0 && area.length > 0.0 && area.width > 0.0)) return Ok{};
  return InvalidInput(path + ": radius = " + NumberText(area.radius) +
                      ", length = " + NumberText(area.length) + ", width = " + NumberText(area.width) +
                      ": a disc has a radius, a rectangle a length and a width, in m");
}

struct ElementPath {
  const List* list = nullptr;
  std::size_t number = 0;  // from 1 on
};

// Of "light.1".
Result<ElementPath> ReadElementPath(std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string name(path.substr(0, dot));
  const List* list = FindByName(Lists(), name);
  if (list == nullptr) return UnknownKey(name);
  const std::optional<std::size_t> number =
      dot == std::string_view::npos ? std::nullopt : ParseNumber<std::size_t>(path.substr(dot + 1));
  if (!number) return InvalidInput(name + " is a list: each of it begins with [[generic." + name + "]]");
  if (*number >= 1 && *number <= kMostElements) return ElementPath{list, *number};
  return InvalidInput(std::string(path) + ": a list has the places 1 to " + std::to_string(kMostElements));
}

std::string TextOf(const KeyValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number != nullptr ? NumberText(*number) : std::get<std::string>(value);
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

std::vector<KeyInfo> DefinitionKeys() {
  std::vector<KeyInfo> keys(Formulas().begin(), Formulas().end());
  for (const List& list : Lists()) std::ranges::copy(list.keys(1), std::back_inserter(keys));
  return keys;
}

Status DefinitionReader::Set(std::string_view path, const KeyValue& value) {
  std::vector<DefinitionKey> keys = Formulas();
  const std::size_t dot = path.rfind('.');
  if (dot != std::string_view::npos) {
    TRY(Begin(path.substr(0, dot)));
    TRY(const ElementPath element, ReadElementPath(path.substr(0, dot)));
    keys = element.list->keys(element.number);
  } else if (FindByName(Lists(), path) != nullptr) {
    return Begin(path);
  }
  const DefinitionKey* key = FindByName(keys, path);
  if (key == nullptr && dot == std::string_view::npos) return UnknownKey(path);
  if (key == nullptr) return InvalidInput(UnknownName("key", path, keys));
  const KeyValue typed = key->type == KeyType::kText ? KeyValue(TextOf(value)) : value;
  if (typed.index() != key->default_value.index())
    return InvalidInput(key->path + " = " + ToToml(typed) + ", expected " + ExpectationOf(*key));
  if (const std::optional<std::string> wrong = CheckValue(*key, typed)) return InvalidInput(*wrong);
  key->set(definition_, typed);
  return Ok{};
}

Status DefinitionReader::Begin(std::string_view path) {
  TRY(const ElementPath element, ReadElementPath(path));
  element.list->grow(definition_, element.number);
  begun_[element.list->name].insert(element.number);
  return Ok{};
}

Result<Definition> DefinitionReader::Finish() const {
  if (definition_.fitness.empty())
    return InvalidInput("[generic] fitness is missing: a formula such as \"largest_cluster / robots\"");
  if (definition_.failure.empty())
    return InvalidInput("[generic] failure is missing: a formula such as \"largest_cluster < 0.5 * robots\"");
  for (const auto& [name, numbers] : begun_) {
    std::size_t expected = 1;
    for (const std::size_t number : numbers) {
      if (number != expected)
        return InvalidInput(name + "." + std::to_string(number) + " without " + name + "." +
                            std::to_string(expected));
      ++expected;
    }
  }
  for (const auto& [name, areas] :
       {std::pair("ground", &definition_.ground), std::pair("source", &definition_.sources),
        std::pair("nest", &definition_.nests)}) {
    for (std::size_t i = 0; i < areas->size(); ++i) {
      TRY(CheckArea(std::string(name) + "." + std::to_string(i + 1), (*areas)[i]));
    }
  }
  return definition_;
}

Result<std::string> DefinitionReader::Text() const {
  TRY(Finish());
  std::string text;
  const auto add = [&](const DefinitionKey& key) {
    const std::string value = TextOf(key.get(definition_));
    if (!value.empty()) text.append(key.path).append(" = ").append(value).append("\n");
  };
  std::ranges::for_each(Formulas(), add);
  for (const List& list : Lists()) {
    for (std::size_t number = 1; number <= list.size(definition_); ++number)
      std::ranges::for_each(list.keys(number), add);
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
      return InvalidInput("the line " + QuoteToml(line) + " of a definition is no NAME = VALUE");
    const std::string path(line.substr(0, equals));
    const std::string value(line.substr(equals + 3));
    const std::optional<double> number = ParseNumber<double>(value);
    const bool formula = FindByName(Formulas(), path) != nullptr;
    entries.emplace_back(path, number && !formula ? KeyValue(*number) : KeyValue(value));
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
