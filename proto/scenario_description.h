// A scenario that a plug-in brings, as a worker tells it: all that its row says without code.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "proto/parameter_description.h"
#include "sim/run_style.h"

namespace gauntlet::proto {

// These are as their namesakes in controllers/behaviour.h and sim/run_style.h.

struct DescribedMetric {
  std::string name;
  std::string unit;
  std::optional<double> none;
  std::string description;
  bool descriptor = false;
  bool operator==(const DescribedMetric&) const = default;
};

struct DescribedFailureType {
  int type = 0;
  std::string name;
  std::string column;
  std::string row;
  bool operator==(const DescribedFailureType&) const = default;
};

struct DescribedFailurePlace {
  std::string x;
  std::string y;
  double same_within = 0.0;  // m
  bool operator==(const DescribedFailurePlace&) const = default;
};

struct DescribedFailureKind {
  std::string metric;
  double at_most = 0.0;
  std::string what;
  bool operator==(const DescribedFailureKind&) const = default;
};

struct DescribedAxis {
  std::string metric;
  double min = 0.0;
  double max = 0.0;
  int parts = 1;
  bool operator==(const DescribedAxis&) const = default;
};

struct DescribedAnnotation {
  std::string kind;
  std::string label;
  sim::Mark mark = sim::Mark::kGoal;
  std::string legend;
  bool operator==(const DescribedAnnotation&) const = default;
};

struct DescribedStyle {
  std::string member;
  std::string lost;
  bool lost_is_failure = true;
  std::string guide;
  std::vector<DescribedAnnotation> annotations;
  bool operator==(const DescribedStyle&) const = default;
};

// As controllers::ScenarioInfo.
struct DescribedScenario {
  std::string name;
  std::string description;
  std::string default_controller;
  bool any_controller = false;
  DescribedStyle style;
  std::vector<DescribedParameter> parameters;
  std::string time_limit;
  std::vector<DescribedMetric> metrics;
  std::string failing;
  std::vector<DescribedFailureType> failure_types;
  std::string failure_columns;
  std::string failure_rows;
  std::string untyped_failure;
  std::string failure_note;
  std::optional<DescribedFailurePlace> failure_place;
  std::vector<DescribedFailureKind> failure_kinds;
  std::vector<DescribedAxis> descriptor_axes;
  bool operator==(const DescribedScenario&) const = default;
};

// What is wrong with it: as CheckParameters; or a metric, a failure type or the time limit that it names and
// does not have; a number that is none; kInvalidInput.
Status CheckScenario(const DescribedScenario& scenario);

nlohmann::ordered_json ScenarioJson(const DescribedScenario& scenario);
// Throws nlohmann::json::exception when it is no scenario.
DescribedScenario ReadScenario(const nlohmann::json& json);

}  // namespace gauntlet::proto
