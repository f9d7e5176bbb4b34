#include "controllers/rows/row_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/number_text.h"
#include "base/parse_number.h"

namespace gauntlet::controllers {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

// Of sim::Mark, in the order of the enumeration.
constexpr std::array<std::string_view, 10> kMarks = {"area", "plan",  "chain",    "goal",   "nest",
                                                     "food", "split", "transfer", "beacon", "former-beacon"};

// Which members a row has, under their names in JSON: `use` takes them one by one, to write or to read them.
void Members(auto& use, sim::AnnotationStyle& row) {
  use("kind", row.kind);
  use("label", row.label);
  use("mark", row.mark);
  use("legend", row.legend);
}
void Members(auto& use, sim::RunStyle& row) {
  use("member", row.member);
  use("lost", row.lost);
  use("lost_is_failure", row.lost_is_failure);
  use("guide", row.guide);
  use("annotations", row.annotations);
}
void Members(auto& use, ParameterInfo& row) {
  std::string type = row.unit == "bool" ? "flag" : row.integer ? "integer" : "number";
  std::string unit = row.unit == "bool" ? "" : row.unit;
  use("name", row.name);
  use("type", type);
  use("unit", unit);
  use("default", row.default_value);
  use("min", row.min);
  use("max", row.max);
  use("description", row.description);
  row.unit = type == "flag" ? "bool" : unit;
  row.integer = type != "number";
}
void Members(auto& use, MetricInfo& row) {
  use("name", row.name);
  use("unit", row.unit);
  use("none", row.none);
  use("descriptor", row.descriptor);
  use("description", row.description);
}
void Members(auto& use, FailureType& row) {
  use("type", row.type);
  use("name", row.name);
  use("column", row.column);
  use("row", row.row);
}
// What the columns and rows of a map of failure types are.
struct MapNames {
  std::string& columns;
  std::string& rows;
};
void Members(auto& use, MapNames& row) {
  use("columns", row.columns);
  use("rows", row.rows);
}
void Members(auto& use, FailurePlace& row) {
  use("x", row.x);
  use("y", row.y);
  use("same_within", row.same_within);
}
void Members(auto& use, FailureKind& row) {
  use("metric", row.metric);
  use("at_most", row.at_most);
  use("what", row.what);
}
void Members(auto& use, DescriptorAxis& row) {
  use("metric", row.metric);
  use("min", row.min);
  use("max", row.max);
  use("parts", row.parts);
}
void Members(auto& use, ControllerInfo& row) {
  use("name", row.name);
  use("description", row.description);
  use("scenario", row.scenario);
  use("parameters", row.parameters);
}
void Members(auto& use, ScenarioInfo& row) {
  use("name", row.name);
  use("description", row.description);
  use("default_controller", row.default_controller);
  use("any_controller", row.any_controller);
  use("style", row.style);
  use("parameters", row.parameters);
  use("time_limit", row.time_limit);
  use("metrics", row.metrics);
  use("failing", row.failing);
  MapNames names{row.failure_types.columns, row.failure_types.rows};
  use("failure_types", row.failure_types.types);
  use("failure_axes", names);
  use("untyped_failure", row.failure_types.untyped);
  use("failure_note", row.failure_types.note);
  use("failure_place", row.failures.place);
  use("failure_kinds", row.failures.kinds);
  use("descriptor_axes", row.failures.axes);
}

class Writer {
 public:
  template <typename T>
  static OrderedJson Value(const T& value) {
    if constexpr (requires(Writer & writer, T & row) { Members(writer, row); }) {
      Writer writer;
      T row = value;
      Members(writer, row);
      return std::move(writer.json_);
    } else {
      return value;
    }
  }
  static OrderedJson Value(double value) {
    return std::isfinite(value) ? OrderedJson(value) : OrderedJson(NumberText(value));
  }
  static OrderedJson Value(sim::Mark mark) { return kMarks.at(static_cast<std::size_t>(mark)); }
  template <typename T>
  static OrderedJson Value(const std::optional<T>& value) {
    return value ? Value(*value) : OrderedJson();
  }
  template <typename T>
  static OrderedJson Value(const std::vector<T>& values) {
    OrderedJson list = OrderedJson::array();
    for (const T& value : values) list.push_back(Value(value));
    return list;
  }

  template <typename T>
  void operator()(const char* name, const T& value) {
    json_[name] = Value(value);
  }

 private:
  OrderedJson json_ = OrderedJson::object();
};

class Reader {
 public:
  explicit Reader(const Json& json) : json_(json) {
    json.get_ref<const Json::object_t&>();  // throws when it is none
  }

  template <typename T>
  static void Read(const Json& json, T& value) {
    if constexpr (requires(Reader & reader, T & row) { Members(reader, row); }) {
      Reader reader(json);
      Members(reader, value);
    } else {
      json.get_to(value);
    }
  }
  static void Read(const Json& json, double& value) {
    const auto text =
        json.is_string() ? ParseNumber<double>(json.get_ref<const std::string&>()) : std::nullopt;
    value = text ? *text : json.get<double>();
  }
  static void Read(const Json& json, sim::Mark& mark) {
    const auto found = std::ranges::find(kMarks, json.get_ref<const std::string&>());
    // A mark that only a newer program knows is drawn as any place is.
    mark = found == kMarks.end() ? sim::Mark::kGoal : static_cast<sim::Mark>(found - kMarks.begin());
  }
  template <typename T>
  static void Read(const Json& json, std::optional<T>& value) {
    if (!json.is_null()) Read(json, value.emplace());
  }
  template <typename T>
  static void Read(const Json& json, std::vector<T>& values) {
    values.clear();
    for (const Json& one : json.get_ref<const Json::array_t&>()) Read(one, values.emplace_back());
  }

  template <typename T>
  void operator()(const char* name, T& value) {
    if (const auto found = json_.find(name); found != json_.end()) Read(*found, value);
  }

 private:
  const Json& json_;
};

template <typename Row>
Row ReadRow(const Json& json) {
  Row row;
  json.at("name").get_to(row.name);
  Reader::Read(json, row);
  return row;
}

}  // namespace

OrderedJson JsonOf(const ScenarioInfo& row) {
  return Writer::Value(row);
}

OrderedJson JsonOf(const ControllerInfo& row) {
  return Writer::Value(row);
}

ScenarioInfo ReadScenario(const Json& json) {
  return ReadRow<ScenarioInfo>(json);
}

ControllerInfo ReadController(const Json& json) {
  return ReadRow<ControllerInfo>(json);
}

}  // namespace gauntlet::controllers
