#include "controllers/command/definition.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "controllers/command/definition_checks.h"
#include "sim/arena/validity.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;

constexpr int kFormat = 1;
constexpr std::size_t kMostElements = 1000;  // of a list

struct Pattern {
  std::string pattern;
};

std::vector<SettingsKey<Definition>> Scalars() {
  using D = Definition;
  return {
      FieldKey<D, &D::case_template>(
          "template", "one of `files`: what {case} is made of; without it the case is JSON as of `export`"),
      FieldKey<D, &D::fitness>("fitness", "formula of metrics, lower = tougher test case; must be given"),
      FieldKey<D, &D::failure>("failure",
                               "formula of metrics, other than 0 = the swarm failed; must be given"),
      NumberKey<D, &D::wall_limit>("wall_limit", "s", 0.1, 604800, "of a run; then it counts as hung"),
      NumberKey<D, &D::cpu_limit>("cpu_limit", "s", 0, 1e8,
                                  "of all processes of a run together; 0 = wall_limit times cores"),
      NumberKey<D, &D::memory>("memory", "MB", 1, 1 << 22, "of all processes of a run together"),
      NumberKey<D, &D::disk>("disk", "MB", 1, 1 << 22, "that a run may leave in its folder"),
      NumberKey<D, &D::cores>("cores", "", 1, 1024, "that a run uses: so many fewer run side by side"),
      NumberKey<D, &D::at_once>("at_once", "", 0, 1024, "runs at the same time on one host; 0 = no limit"),
      FieldKey<D, &D::setup>("setup", "commands for bash, once for each worker; runs get the environment"),
      FieldKey<D, &D::trajectory>("trajectory", "CSV in the run's folder: time, robot, kind, x, y, heading"),
      FieldKey<D, &D::confine>("confine", "false: the program may use setuid helpers"),
      NumberKey<D, &D::robot_radius>("robot_radius", "m", 0.001, 10, "for which a path is left"),
  };
}

// Arrays of texts.
struct Texts {
  std::string name;
  std::vector<std::string> Definition::*member;
  std::string description;
};
const std::vector<Texts>& TextArrays() {
  static const std::vector<Texts> arrays = {
      {"run", &Definition::run, "program and arguments, with {case}, {out}, {seed}, {parameters.NAME}"},
      {"files", &Definition::names,
       "files and folders beside the experiment that every run finds in its own"},
      {"probe", &Definition::probe, "program and arguments that print the same on every worker: a version"},
  };
  return arrays;
}

std::string JsonText(const json& value) {
  return value.dump(-1, ' ', /*ensure_ascii=*/false, json::error_handler_t::replace);
}

std::optional<KeyValue> ValueOf(const KeyInfo& key, const json& value) {
  if (key.type == KeyType::kText && value.is_string()) return value.get<std::string>();
  if (key.type == KeyType::kText && value.is_number()) return NumberText(value.get<double>());
  if (key.type == KeyType::kFlag && value.is_boolean()) return value.get<bool>();
  if (key.type == KeyType::kInteger && value.is_number_integer()) return value.get<std::int64_t>();
  if (key.type == KeyType::kNumber && value.is_number()) return value.get<double>();
  return std::nullopt;
}

std::string PathOf(const std::string& prefix, const std::string& name) {
  return prefix.empty() ? name : prefix + "." + name;
}

template <typename Settings>
std::optional<Complaint> SetKey(const std::vector<SettingsKey<Settings>>& keys, const std::string& prefix,
                                const std::string& name, const json& value, Settings& settings) {
  const std::string path = PathOf(prefix, name);
  const SettingsKey<Settings>* key = FindByName(keys, name);
  if (key == nullptr) return Complaint{path, UnknownName("key", name, keys)};
  const std::optional<KeyValue> typed = ValueOf(*key, value);
  if (!typed) return Complaint{path, path + " = " + JsonText(value) + ", expected " + ExpectationOf(*key)};
  KeyInfo named = *key;
  named.path = path;
  if (const std::optional<std::string> wrong = CheckValue(named, *typed)) return Complaint{path, *wrong};
  key->set(settings, *typed);
  return std::nullopt;
}

json JsonOf(const KeyValue& value) {
  return std::visit([](const auto& held) { return json(held); }, value);
}

// A list of tables.
struct List {
  std::string name;
  std::function<std::optional<Complaint>(const json& array, Definition&)> read;
  std::function<json(const Definition&)> write;
  std::vector<KeyInfo> keys;
  bool canonical_only = false;
};

template <typename Element>
List ListOf(const std::string& name, std::vector<Element> Definition::*member,
            const std::vector<SettingsKey<Element>>& keys) {
  List list{.name = name, .read = {}, .write = {}, .keys = {keys.begin(), keys.end()}};
  list.read = [=](const json& array, Definition& definition) -> std::optional<Complaint> {
    if (!array.is_array() || array.size() > kMostElements)
      return Complaint{name, name + " is a list of at most " + std::to_string(kMostElements) +
                                 " tables: each begins with [[command." + name + "]]"};
    for (const json& table : array) {
      Element element;
      const std::string path = name + "." + std::to_string((definition.*member).size() + 1);
      if (!table.is_object()) return Complaint{path, path + " is no table"};
      for (const auto& [key, value] : table.items()) {
        if (auto complaint = SetKey(keys, path, key, value, element)) return complaint;
      }
      (definition.*member).push_back(std::move(element));
    }
    return std::nullopt;
  };
  list.write = [=](const Definition& definition) {
    json array = json::array();
    for (const Element& element : definition.*member) {
      json table = json::object();
      for (const SettingsKey<Element>& key : keys) table[key.path] = JsonOf(key.get(element));
      array.push_back(std::move(table));
    }
    return array;
  };
  return list;
}

std::vector<SettingsKey<Shape>> ShapeKeys() {
  using S = Shape;
  constexpr double kFar = sim::kMaxCoordinate;
  return {NumberKey<S, &S::x>("x", "m", -kFar, kFar, "of its centre"),
          NumberKey<S, &S::y>("y", "m", -kFar, kFar, "of its centre"),
          NumberKey<S, &S::radius>("radius", "m", 0, kFar, "of a disc"),
          NumberKey<S, &S::length>("length", "m", 0, kFar, "of a rectangle, along x before it is turned"),
          NumberKey<S, &S::width>("width", "m", 0, kFar, "of a rectangle, along y"),
          NumberKey<S, &S::degrees>("degrees", "degrees", -360, 360, "by which it is turned")};
}

std::vector<SettingsKey<ParameterInfo>> ParameterKeys() {
  using P = ParameterInfo;
  constexpr double kMost = 1e300;
  return {FieldKey<P, &P::name>("name", "for {parameters.NAME} and --set controller_parameters.NAME"),
          NumberKey<P, &P::default_value>("default", "", -kMost, kMost, ""),
          NumberKey<P, &P::min>("low", "", -kMost, kMost, "the least that it may be"),
          NumberKey<P, &P::max>("high", "", -kMost, kMost, "the most"),
          FieldKey<P, &P::integer>("integer", "it is a whole number; a flag is one from 0 to 1"),
          FieldKey<P, &P::unit>("unit", "for people"),
          FieldKey<P, &P::description>("description", "for people")};
}

const std::vector<List>& Lists() {
  static const std::vector<List> lists = [] {
    using M = Metric;
    using A = DescriptorAxis;
    std::vector<List> all = {
        ListOf<M>(
            "metric", &Definition::metrics,
            {FieldKey<M, &M::name>("name", "letters, digits and _"),
             FieldKey<M, &M::from>(
                 "from", "log:PATTERN, csv:FILE:COLUMN or trajectory:MEASURE; without it, from the JSON"),
             FieldKey<M, &M::formula>("formula", "of the metrics before it, in place of `from`"),
             FieldKey<M, &M::unit>("unit", "for people; yes/no of 0 and 1")}),
        ListOf<ParameterInfo>("parameter", &Definition::parameters, ParameterKeys()),
        ListOf<Point>("point", &Definition::points,
                      {FieldKey<Point, &Point::name>("name", "for messages"),
                       NumberKey<Point, &Point::x>("x", "m", -sim::kMaxCoordinate, sim::kMaxCoordinate, ""),
                       NumberKey<Point, &Point::y>("y", "m", -sim::kMaxCoordinate, sim::kMaxCoordinate, "")}),
        ListOf<Shape>("keep_out", &Definition::keep_outs, ShapeKeys()),
        ListOf<Shape>("standing", &Definition::standing, ShapeKeys()),
        ListOf<A>("axis", &Definition::axes,
                  {FieldKey<A, &A::metric>("metric", "whose range is cut into the cells of an archive"),
                   NumberKey<A, &A::min>("min", "", -1e300, 1e300, ""),
                   NumberKey<A, &A::max>("max", "", -1e300, 1e300, ""),
                   NumberKey<A, &A::parts>("parts", "", 1, 1000, "into which it is cut")}),
        ListOf<File>("file", &Definition::files,
                     {FieldKey<File, &File::name>("name", ""), FieldKey<File, &File::hash>("sha256", ""),
                      FieldKey<File, &File::executable>("executable", "")}),
    };
    all.back().canonical_only = true;
    return all;
  }();
  return lists;
}

// Those of `refused`, `place` and `metrics`, which the structs hold in another form.
std::optional<Complaint> ReadRest(const std::string& name, const json& value, Definition& definition,
                                  bool& known) {
  known = true;
  if (name == "refused") {
    std::vector<SettingsKey<Pattern>> keys = {
        FieldKey<Pattern, &Pattern::pattern>("pattern", "in its output: this case cannot begin")};
    if (!value.is_array())
      return Complaint{name, "refused is a list: each of it begins with [[command.refused]]"};
    for (const json& table : value) {
      Pattern one;
      const std::string path = "refused." + std::to_string(definition.refused.size() + 1);
      for (const auto& [key, text] : table.items()) {
        if (auto complaint = SetKey(keys, path, key, text, one)) return complaint;
      }
      definition.refused.push_back(one.pattern);
    }
    return std::nullopt;
  }
  if (name == "place") {
    using P = FailurePlace;
    definition.place.emplace();
    for (const auto& [key, part] : value.items()) {
      if (auto complaint = SetKey<P>({FieldKey<P, &P::x>("x", "metric"), FieldKey<P, &P::y>("y", "metric"),
                                      NumberKey<P, &P::same_within>("same_within", "m", 0, 1000, "")},
                                     name, key, part, *definition.place))
        return complaint;
    }
    return std::nullopt;
  }
  known = false;
  return std::nullopt;
}

std::optional<Complaint> ReadTexts(const std::string& name, const json& value,
                                   std::vector<std::string>& texts) {
  const bool right =
      value.is_array() && std::ranges::all_of(value, [](const json& one) { return one.is_string(); });
  if (!right) return Complaint{name, name + " = " + JsonText(value) + ", expected a list of texts"};
  if (value.size() > kMostElements)
    return Complaint{name, name + " has " + std::to_string(value.size()) + " texts; " +
                               std::to_string(kMostElements) + " are possible"};
  for (const json& one : value) texts.push_back(one.get<std::string>());
  return std::nullopt;
}

}  // namespace

std::vector<std::string> Definition::Reported() const {
  std::vector<std::string> reported;
  for (const Metric& metric : metrics) {
    if (metric.from.empty() && metric.formula.empty()) reported.push_back(metric.name);
  }
  return reported;
}

ReadDefinition Read(const json& table) {
  ReadDefinition read;
  Definition& definition = read.definition;
  const auto keys = Scalars();
  std::vector<std::string> reported;
  for (const auto& [name, value] : table.items()) {
    bool known = false;
    if (name == "format") continue;
    if (name == "metrics") {
      read.complaint = ReadTexts(name, value, reported);
    } else if (const Texts* texts = FindByName(TextArrays(), name)) {
      read.complaint = ReadTexts(name, value, definition.*texts->member);
    } else if (const List* list = FindByName(Lists(), name)) {
      read.complaint = list->read(value, definition);
    } else if (read.complaint = ReadRest(name, value, definition, known); !known) {
      std::vector<std::string_view> names;
      for (const auto& key : keys) names.push_back(key.path);
      for (const Texts& one : TextArrays()) names.push_back(one.name);
      for (const List& one : Lists()) {
        if (!one.canonical_only) names.push_back(one.name);
      }
      names.insert(names.end(), {"metrics", "refused", "place"});
      read.complaint = FindByName(keys, name) != nullptr
                           ? SetKey(keys, "", name, value, definition)
                           : Complaint{name, "[command]: " + UnknownName("key", name, names)};
    }
    if (read.complaint) return read;
  }
  std::vector<Metric> all;
  for (const std::string& name : reported)
    all.push_back({.name = name, .from = "", .formula = "", .unit = ""});
  definition.metrics.insert(definition.metrics.begin(), all.begin(), all.end());
  read.complaint = FindContradiction(definition, reported.size());
  return read;
}

Result<Definition> Parse(std::string_view canonical) {
  const json table = json::parse(canonical, nullptr, /*allow_exceptions=*/false);
  if (!table.is_object() || table.value("format", 0) != kFormat)
    return InvalidInput("it is no definition of a command in format " + std::to_string(kFormat));
  ReadDefinition read = Read(table);
  if (read.complaint) return InvalidInput(read.complaint->what);
  return std::move(read.definition);
}

std::string CanonicalText(const Definition& definition) {
  json table = {{"format", kFormat}};
  for (const auto& key : Scalars()) table[key.path] = JsonOf(key.get(definition));
  table["run"] = definition.run;
  table["probe"] = definition.probe;
  for (const List& list : Lists()) table[list.name] = list.write(definition);
  table["refused"] = json::array();
  for (const std::string& pattern : definition.refused) table["refused"].push_back({{"pattern", pattern}});
  if (definition.place)
    table["place"] = {{"x", definition.place->x},
                      {"y", definition.place->y},
                      {"same_within", definition.place->same_within}};
  return table.dump(1) + "\n";
}

std::vector<KeyInfo> Keys() {
  std::vector<KeyInfo> keys;
  for (const Texts& texts : TextArrays()) {
    KeyInfo& key = keys.emplace_back();
    key.path = texts.name;
    key.type = KeyType::kText;
    key.description = texts.description + " (a list)";
  }
  const Definition defaults;
  for (const auto& key : Scalars()) keys.emplace_back(key).default_value = key.get(defaults);
  for (const List& list : Lists()) {
    if (list.canonical_only) continue;
    for (KeyInfo key : list.keys) {
      key.path = list.name + ".1." + key.path;
      keys.push_back(std::move(key));
    }
  }
  return keys;
}

}  // namespace gauntlet::controllers::command
