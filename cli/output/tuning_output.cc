#include "cli/output/tuning_output.h"

#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

Json ValueJson(const TriedValue& value) {
  Json json = {
      {"value", value.value},           {"baseline", value.is_baseline}, {"simulations", value.simulations},
      {"evolutions", value.evolutions}, {"median", value.median},        {"mean", value.mean}};
  if (value.is_baseline) return json;
  json["a"] = value.a;
  json["a_interval"] = value.interval ? Json::array({value.interval->low, value.interval->high}) : Json();
  json["effect"] = value.effect;
  json["exceeds"] = value.exceeds;
  json["p_two_sided"] = value.p;
  json["p_holm"] = value.p_holm;
  return json;
}

}  // namespace

Json TuningJson(const StudySection& section) {
  const TuningResult& tuning = *section.tuning;
  Json parameters = Json::array();
  for (const TriedParameter& parameter : tuning.parameters) {
    Json values = Json::array();
    for (const TriedValue& value : parameter.values) values.push_back(ValueJson(value));
    parameters.push_back({{"key", parameter.key},
                          {"baseline", parameter.baseline},
                          {"recommended", parameter.recommended},
                          {"evidence", parameter.evidence},
                          {"values", std::move(values)}});
  }
  Json consistency = Json::array();
  for (const analysis::Consistency& one : tuning.consistency)
    consistency.push_back({{"repeats", one.size}, {"median_a", one.median_a}, {"max_a", one.max_a}});
  return {{"analysis", section.name},
          {"parameters", std::move(parameters)},
          {"consistency", std::move(consistency)},
          {"enough", tuning.enough ? Json(*tuning.enough) : Json()},
          {"enough_in_words", tuning.enough_in_words},
          {"p_by", tuning.p_by}};
}

}  // namespace gauntlet
