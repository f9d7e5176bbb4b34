#include "proto/scenario_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"

namespace gauntlet::proto {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view kTotalFailure = "total_failure";
constexpr std::string_view kYesNo = "yes/no";
// As many as an axis of a map can show.
constexpr int kMostParts = 1000;

// Of sim::Mark, in the order of the enumeration.
constexpr std::array<std::string_view, 10> kMarks = {"area", "plan",  "chain",    "goal",   "nest",
                                                     "food", "split", "transfer", "beacon", "former-beacon"};

std::string_view NameOf(sim::Mark mark) {
  return kMarks.at(static_cast<std::size_t>(mark));
}

// Throws nlohmann::json::exception when there is none of that name.
sim::Mark MarkOf(const std::string& name) {
  static const Json numbers = [] {
    Json by_name;
    for (std::size_t i = 0; i < kMarks.size(); ++i) by_name[kMarks[i]] = i;
    return by_name;
  }();
  return static_cast<sim::Mark>(numbers.at(name).get<int>());
}

// A family of metrics, "food_window_*", is named without its last character.
std::string_view StemOf(std::string_view name) {
  return name.ends_with('*') ? name.substr(0, name.size() - 1) : name;
}

const DescribedMetric* MetricOf(const DescribedScenario& scenario, std::string_view name) {
  const auto found = std::ranges::find_if(scenario.metrics, [&](const DescribedMetric& metric) {
    return metric.name.ends_with('*') ? name.starts_with(StemOf(metric.name)) : metric.name == name;
  });
  return found == scenario.metrics.end() ? nullptr : &*found;
}

Status RequireMetric(const DescribedScenario& scenario, std::string_view who, const std::string& name) {
  if (MetricOf(scenario, name) != nullptr) return Ok{};
  return InvalidInput(
      fmt::format("{} is of the metric '{}', which is none of its metrics", who, Printable(name)));
}

Status CheckMetrics(const DescribedScenario& scenario) {
  std::set<std::string> names;
  for (const DescribedMetric& metric : scenario.metrics) {
    if (!IsName(StemOf(metric.name))) return WrongName("metric", metric.name);
    if (!names.insert(metric.name).second)
      return InvalidInput(fmt::format("metric '{}' is given twice", metric.name));
    if (metric.none && !std::isfinite(*metric.none))
      return InvalidInput(fmt::format("metric '{}': what stands for none must be a number, not {}",
                                      metric.name, NumberText(*metric.none)));
  }
  if (scenario.failing == kTotalFailure) return Ok{};
  const DescribedMetric* failing = MetricOf(scenario, scenario.failing);
  if (failing != nullptr && failing->unit == kYesNo) return Ok{};
  return InvalidInput(fmt::format("failing = '{}' is neither {} nor a metric with the unit {}",
                                  Printable(scenario.failing), kTotalFailure, kYesNo));
}

Status CheckFailures(const DescribedScenario& scenario) {
  std::set<int> types;
  for (const DescribedFailureType& one : scenario.failure_types) {
    if (one.type < 0 || one.name.empty())
      return InvalidInput(fmt::format("failure type {}: it needs a number from 0 on and a name", one.type));
    if (!types.insert(one.type).second)
      return InvalidInput(fmt::format("failure type {} is given twice", one.type));
  }
  for (const DescribedFailureKind& kind : scenario.failure_kinds) {
    TRY(RequireMetric(scenario, "a failure kind", kind.metric));
    if (!std::isfinite(kind.at_most))
      return InvalidInput(
          fmt::format("the failure kind of '{}' is one up to {}", kind.metric, NumberText(kind.at_most)));
  }
  if (!scenario.failure_place) return Ok{};
  for (const std::string& name : {scenario.failure_place->x, scenario.failure_place->y}) {
    TRY(RequireMetric(scenario, "the failure's place", name));
  }
  const double same_within = scenario.failure_place->same_within;
  if (same_within > 0.0 && std::isfinite(same_within)) return Ok{};
  return InvalidInput(fmt::format("the failure's place is the same within {} m; more than 0 is needed",
                                  NumberText(same_within)));
}

Status CheckAxes(const DescribedScenario& scenario) {
  for (const DescribedAxis& axis : scenario.descriptor_axes) {
    TRY(RequireMetric(scenario, "a descriptor axis", axis.metric));
    const bool right = std::isfinite(axis.min) && std::isfinite(axis.max) && axis.min < axis.max;
    if (!right || axis.parts < 1 || axis.parts > kMostParts) {
      return InvalidInput(
          fmt::format("the descriptor axis of '{}' goes from {} to {} in {} parts; 1 to {} "
                      "parts of a range are possible",
                      axis.metric, NumberText(axis.min), NumberText(axis.max), axis.parts, kMostParts));
    }
  }
  return Ok{};
}

OrderedJson StyleJson(const DescribedStyle& style) {
  OrderedJson annotations = OrderedJson::array();
  for (const DescribedAnnotation& one : style.annotations) {
    annotations.push_back(
        {{"kind", one.kind}, {"label", one.label}, {"mark", NameOf(one.mark)}, {"legend", one.legend}});
  }
  return {{"member", style.member},
          {"lost", style.lost},
          {"lost_is_failure", style.lost_is_failure},
          {"guide", style.guide},
          {"annotations", std::move(annotations)}};
}

DescribedStyle ReadStyle(const Json& json) {
  DescribedStyle style{.member = json.at("member"),
                       .lost = json.at("lost"),
                       .lost_is_failure = json.at("lost_is_failure"),
                       .guide = json.at("guide"),
                       .annotations = {}};
  for (const Json& one : json.at("annotations")) {
    style.annotations.push_back({.kind = one.at("kind"),
                                 .label = one.at("label"),
                                 .mark = MarkOf(one.at("mark")),
                                 .legend = one.at("legend")});
  }
  return style;
}

OrderedJson MetricsJson(const std::vector<DescribedMetric>& metrics) {
  OrderedJson list = OrderedJson::array();
  for (const DescribedMetric& one : metrics) {
    list.push_back({{"name", one.name},
                    {"unit", one.unit},
                    {"none", one.none ? OrderedJson(*one.none) : OrderedJson()},
                    {"description", one.description},
                    {"descriptor", one.descriptor}});
  }
  return list;
}

std::vector<DescribedMetric> ReadMetrics(const Json& json) {
  std::vector<DescribedMetric> metrics;
  for (const Json& one : json) {
    const Json& none = one.at("none");
    metrics.push_back({.name = one.at("name"),
                       .unit = one.at("unit"),
                       .none = none.is_null() ? std::nullopt : std::optional(none.get<double>()),
                       .description = one.at("description"),
                       .descriptor = one.at("descriptor")});
  }
  return metrics;
}

// Of how its runs fail.
void AddFailures(const DescribedScenario& scenario, OrderedJson& json) {
  json["failing"] = scenario.failing;
  json["failure_types"] = OrderedJson::array();
  for (const DescribedFailureType& one : scenario.failure_types) {
    json["failure_types"].push_back(
        {{"type", one.type}, {"name", one.name}, {"column", one.column}, {"row", one.row}});
  }
  json["failure_columns"] = scenario.failure_columns;
  json["failure_rows"] = scenario.failure_rows;
  json["untyped_failure"] = scenario.untyped_failure;
  json["failure_note"] = scenario.failure_note;
  json["failure_place"] = nullptr;
  if (const auto& place = scenario.failure_place)
    json["failure_place"] = {{"x", place->x}, {"y", place->y}, {"same_within", place->same_within}};
  json["failure_kinds"] = OrderedJson::array();
  for (const DescribedFailureKind& one : scenario.failure_kinds)
    json["failure_kinds"].push_back({{"metric", one.metric}, {"at_most", one.at_most}, {"what", one.what}});
  json["descriptor_axes"] = OrderedJson::array();
  for (const DescribedAxis& one : scenario.descriptor_axes) {
    json["descriptor_axes"].push_back(
        {{"metric", one.metric}, {"min", one.min}, {"max", one.max}, {"parts", one.parts}});
  }
}

void ReadFailures(const Json& json, DescribedScenario& scenario) {
  scenario.failing = json.at("failing");
  for (const Json& one : json.at("failure_types")) {
    scenario.failure_types.push_back(
        {.type = one.at("type"), .name = one.at("name"), .column = one.at("column"), .row = one.at("row")});
  }
  scenario.failure_columns = json.at("failure_columns");
  scenario.failure_rows = json.at("failure_rows");
  scenario.untyped_failure = json.at("untyped_failure");
  scenario.failure_note = json.at("failure_note");
  if (const Json& place = json.at("failure_place"); !place.is_null()) {
    scenario.failure_place = {.x = place.at("x"), .y = place.at("y"), .same_within = place.at("same_within")};
  }
  for (const Json& one : json.at("failure_kinds")) {
    scenario.failure_kinds.push_back(
        {.metric = one.at("metric"), .at_most = one.at("at_most"), .what = one.at("what")});
  }
  for (const Json& one : json.at("descriptor_axes")) {
    scenario.descriptor_axes.push_back(
        {.metric = one.at("metric"), .min = one.at("min"), .max = one.at("max"), .parts = one.at("parts")});
  }
}

}  // namespace

Status CheckScenario(const DescribedScenario& scenario) {
  if (!IsName(scenario.name)) return WrongName("scenario", scenario.name);
  const auto in_scenario = [&](const std::string& what) {
    return InvalidInput(fmt::format("scenario '{}': {}", scenario.name, what));
  };
  if (!IsName(scenario.default_controller)) return in_scenario("its default_controller names no controller");
  for (const Status& right : {CheckParameters(scenario.parameters), CheckMetrics(scenario),
                              CheckFailures(scenario), CheckAxes(scenario)}) {
    if (!right) return in_scenario(right.error().message);
  }
  if (std::ranges::count(scenario.parameters, scenario.time_limit, &DescribedParameter::name) > 0)
    return Ok{};
  return in_scenario(
      fmt::format("its time limit '{}', in s, is none of its parameters", Printable(scenario.time_limit)));
}

OrderedJson ScenarioJson(const DescribedScenario& scenario) {
  OrderedJson json = {{"name", scenario.name},
                      {"description", scenario.description},
                      {"default_controller", scenario.default_controller},
                      {"any_controller", scenario.any_controller},
                      {"style", StyleJson(scenario.style)},
                      {"parameters", ParametersJson(scenario.parameters)},
                      {"time_limit", scenario.time_limit},
                      {"metrics", MetricsJson(scenario.metrics)}};
  AddFailures(scenario, json);
  return json;
}

DescribedScenario ReadScenario(const Json& json) {
  DescribedScenario scenario;
  scenario.name = json.at("name");
  scenario.description = json.at("description");
  scenario.default_controller = json.at("default_controller");
  scenario.any_controller = json.at("any_controller");
  scenario.style = ReadStyle(json.at("style"));
  scenario.parameters = ReadParameters(json.at("parameters"));
  scenario.time_limit = json.at("time_limit");
  scenario.metrics = ReadMetrics(json.at("metrics"));
  ReadFailures(json, scenario);
  return scenario;
}

}  // namespace gauntlet::proto
