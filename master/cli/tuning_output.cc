#include "master/cli/tuning_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/figures/tuning_figure.h"
#include "master/cli/table.h"

namespace gauntlet::master {
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

analysis::RobustnessFigure RobustnessOf(const StudySection& section) {
  analysis::RobustnessFigure figure;
  figure.title = section.title;
  figure.outcome = "Robustness analysis: one value changed at a time. " + section.sentences.back();
  figure.low = "easier cases than the baseline";
  figure.high = "tougher cases";
  for (const TriedParameter& parameter : section.tuning->parameters) {
    analysis::RobustnessGroup& group = figure.groups.emplace_back();
    group.parameter = parameter.key;
    for (const TriedValue& value : parameter.values) {
      group.points.push_back({.value = value.value,
                              .remark = fmt::format("median {}, {} simulations", FormatFitness(value.median),
                                                    FormatCount(value.simulations)),
                              .is_baseline = value.is_baseline,
                              .a = value.a,
                              .interval = value.interval,
                              .exceeds = value.exceeds});
    }
  }
  return figure;
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

std::vector<std::pair<std::string, std::string>> TuningPictures(const StudySection& section) {
  std::vector<std::pair<std::string, std::string>> pictures = {
      {"robustness", analysis::DrawRobustness(RobustnessOf(section))}};
  if (section.tuning->consistency.empty()) return pictures;
  const auto& enough = section.tuning->enough;
  const std::string outcome =
      enough ? fmt::format("Consistency analysis: {} repeats are enough", *enough)
             : std::string("Consistency analysis: more repeats are needed than were looked at");
  pictures.emplace_back("consistency",
                        analysis::DrawConsistency({section.title, outcome, section.tuning->consistency}));
  return pictures;
}

}  // namespace gauntlet::master
