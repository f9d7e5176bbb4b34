#include "controllers/aggregation/aggregation_registry.h"

#include <array>

#include "controllers/aggregation/aggregation_controller.h"
#include "controllers/aggregation/aggregation_scenario.h"

namespace gauntlet::controllers::aggregation {
namespace {

const std::vector<MetricInfo> kAggregationMetrics = {
    {"largest_cluster", "", {}, "share of the robots in the largest cluster at the end"},
    {"second_cluster", "", {}, "share of the robots in the next largest one", true},
    {"clusters", "", {}, "clusters at the end, robots on their own among them", true},
    {"expected_cluster_size", "", {}, "robots in the cluster of a robot that is picked at random"},
    {"dispersion", "", {}, "second moment of the positions over the square of a robot's diameter"},
    {"total_distance", "m", {}, "sum of the distances of all pairs of robots at the end"},
    {"time_to_90", "s", kNotMeasured, "until nine of ten robots were in one cluster for the first time"},
    {"split_time", "s", kNotMeasured, "when the two largest clusters of the end last hung together", true},
    {"clusters_in_sight", "yes/no", kNotMeasured, "whether the two largest have each other in sight", true},
    {"stuck_robots", "", {}, "robots on their own that kept to one place in the last minute", true},
    {"largest_x", "m", {}, "where the largest cluster is: mean of its robots", true},
    {"largest_y", "m", {}, "where the largest cluster is: mean of its robots", true},
    {"second_x", "m", kNowhere, "where the next largest one is", true},
    {"second_y", "m", kNowhere, "where the next largest one is", true},
    {"median_x", "m", {}, "median of the robots' places over the run, to the right", true},
    {"median_y", "m", {}, "median of the robots' places over the run, upwards", true},
    {"spread_x", "m", {}, "standard deviation of the robots' places over the run, to the right", true},
    {"spread_y", "m", {}, "standard deviation of the robots' places over the run, upwards", true},
};

const std::vector<sim::AnnotationStyle> kAggregationAnnotations = {
    {"disc", "largest cluster", sim::Mark::kGoal, ""},
    {"disc", "second cluster", sim::Mark::kNest, ""},
};

FailureTypes AggregationFailureTypes() {
  FailureTypes all{.columns = "what the robots outside the largest cluster do",
                   .rows = "where the largest cluster is"};
  for (int type = 0; type < kFailureTypes; ++type)
    all.types.push_back(
        {type, FailureLabel(type), FailureDivision(type), std::string(NameOfPlace(type / 4))});
  return all;
}

const ParameterTable<AggregationScenarioSettings>& ScenarioTable() {
  using S = AggregationScenarioSettings;
  static const ParameterTable<S> table({
      {"robots", "", 20, 1, 100, Into<&S::robots>(),
       "robots under test; a test case may override it (chosen)"},
      {"time_limit", "s", 600, 1, 3600, IntoTicks<&S::tick_limit>(), "length of a run (chosen)"},
      {"camera_range", "m", 9, 0.2, 100.0, Into<&S::camera_range>(),
       "half side of the square that a robot sees; the default sees the whole arena (chosen: the published "
       "controller needs a sensor of long range)"},
      {"link_range", "m", 0.34, 0.17, 3.0, Into<&S::link_range>(),
       "robots nearer than this and in sight are one cluster (chosen: four radii, no third fits between)"},
      {"corner_distance", "m", 0.5, 0.2, 2.9, Into<&S::corner_distance>(),
       "the points between which a path is left, from the walls' centre lines (as the thesis' flock)"},
      {"open_share", "", 0.75, 0.0, 1.0, Into<&S::open_share>(),
       "of what robots reach in the empty arena, as much must be left (chosen)"},
  });
  return table;
}

const ParameterTable<AggregationSettings>& MinimalTable() {
  using S = AggregationSettings;
  static const ParameterTable<S> table({
      {"speed", "m/s", 0.1, 0.005, 0.3, Into<&S::speed>(), "largest speed of a wheel (chosen)"},
      {"alone_left", "", -0.7, -1.0, 1.0, Into<&S::alone_left>(),
       "left wheel while nobody is ahead, share of speed (Gauci et al. 2014)"},
      {"alone_right", "", -1.0, -1.0, 1.0, Into<&S::alone_right>(),
       "right wheel while nobody is ahead, share of speed (Gauci et al. 2014)"},
      {"seeing_left", "", 1.0, -1.0, 1.0, Into<&S::seeing_left>(),
       "left wheel while somebody is ahead, share of speed (Gauci et al. 2014)"},
      {"seeing_right", "", -1.0, -1.0, 1.0, Into<&S::seeing_right>(),
       "right wheel while somebody is ahead, share of speed (Gauci et al. 2014)"},
  });
  return table;
}

const ParameterTable<AggregationSettings>& ImprovedTable() {
  using S = AggregationSettings;
  static const ParameterTable<S> table(
      MinimalTable(),
      {
          {"near_range", "m", 2.5, 0.18, 10.0, Into<&S::near_range>(),
           "robots in sight that are nearer are neighbours (calibrated)"},
          {"quorum", "", 10, 0, 100, Into<&S::quorum>(),
           "a robot with fewer neighbours may leave; 10 and itself are a majority of 20 (chosen)"},
          {"leave_rate", "1/s", 0.01, 0.0, 10.0, Into<&S::leave_rate>(),
           "how often it leaves then (calibrated)"},
          {"walk_time", "s", 20.0, 0.1, 600.0, IntoTicks<&S::walk_ticks>(),
           "a robot that leaves walks at random for this long (calibrated)"},
      });
  return table;
}

ControllerFactory MakeAggregators(const AggregationSettings& settings) {
  return {[settings](const ControllerContext&) { return std::make_unique<AggregationController>(settings); }};
}

}  // namespace

const ScenarioInfo& AggregationScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<AggregationScenario>(
      ScenarioTable(),
      {
          .name = "aggregation",
          .description = "robots that begin anywhere gather in one cluster",
          .default_controller = "aggregation-minimal",
          .style = {.lost = "left out", .annotations = kAggregationAnnotations},
          .metrics = kAggregationMetrics,
          .failures = {.axes = {{"clusters", 2.0, 12.0, 5}, {"clusters_in_sight", 0.0, 1.0, 2}}},
          .failure_types = AggregationFailureTypes(),
      });
  return info;
}

std::span<const ControllerInfo> AggregationControllers() {
  static const std::array rows = {
      ControllerRow("aggregation-minimal", "aggregation",
                    "sees whether somebody is straight ahead, nothing else (Gauci et al. 2014)",
                    MinimalTable(), MakeAggregators),
      ControllerRow("aggregation-minimal-improved", "aggregation",
                    "the same, but a robot with too few neighbours leaves now and then", ImprovedTable(),
                    MakeAggregators),
  };
  return rows;
}

}  // namespace gauntlet::controllers::aggregation
