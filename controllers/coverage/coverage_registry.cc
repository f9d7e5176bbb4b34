#include "controllers/coverage/coverage_registry.h"

#include <array>

#include "controllers/coverage/coverage_controller.h"
#include "controllers/coverage/coverage_scenario.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::coverage {
namespace {

const std::vector<MetricInfo> kCoverageMetrics = {
    {"covered", "", {}, "share of the reachable cells that some robot covers, mean over the last 30 s", true},
    {"explored", "", {}, "share of the reachable cells that some robot came near and saw", true},
    {"neighbour_distance", "m", {}, "mean distance of a robot to the nearest other at the end", true},
    {"connected_share", "", {}, "share of the robots in the largest linked group at the end", true},
    {"path_length", "m", {}, "mean length of the robots' ways", true},
    {"stuck_robots", "", {}, "robots that meant to move in the last minute and did not", true},
    {"largest_hole", "m^2", {}, "area of the largest connected region that nobody covers at the end", true},
    {"hole_x", "m", kNowhere, "where that region is: its centroid", true},
    {"hole_y", "m", kNowhere, "where that region is: its centroid", true},
};

const std::vector<sim::AnnotationStyle> kCoverageAnnotations = {
    {"area", "", sim::Mark::kArea, "area the swarm starts in"},
    {"disc", "largest hole", sim::Mark::kGoal, "largest hole: its centroid and area"},
};

const ParameterTable<CoverageScenarioSettings>& CoverageScenarioParameters() {
  using S = CoverageScenarioSettings;
  static const ParameterTable<S> table({
      {"robots", "", 20, 1, 100, Into<&S::robots>(), "robots; a test case may override it (chosen)"},
      {"time_limit", "s", 300, 1, 3600, IntoTicks<&S::tick_limit>(), "length of a run (chosen)"},
      {"corner_distance", "m", 0.5, 0.2, 2.9, Into<&S::corner_distance>(),
       "start, and goal of the way that must be left, from the walls' centre lines (chosen)"},
      {"open_share", "", 0.75, 0.0, 1.0, Into<&S::open_share>(),
       "share of the empty arena that obstacles must leave connected with the start (chosen)"},
      {"spawn_side", "m", 1.5, 0.3, 6.0, Into<&S::spawn_side>(),
       "square in the corner that robots start in (chosen)"},
      {"coverage_radius", "m", 0.75, 0.1, 3.0, Into<&S::coverage_radius>(),
       "a robot covers what it sees up to here (chosen)"},
      {"least_covered", "", 0.4, 0.0, 1.0, Into<&S::least_covered>(),
       "a swarm that covers a smaller share failed totally (chosen)"},
  });
  return table;
}

const ParameterTable<CoverageSettings>& CoverageFieldParameters() {
  using S = CoverageSettings;
  static const ParameterTable<S> table({
      {"neighbour_range", "m", 1.5, 0.2, 3.0, Into<&S::neighbour_range>(),
       "robots nearer than this push each other away (chosen)"},
      {"obstacle_push", "1/m^2", 3.0, 0.0, 100.0, Into<&S::obstacle_push>(),
       "force of a proximity reading of 1, away from what it sees (chosen)"},
      {"gain", "m^3/s", 0.05, 0.0, 1.0, Into<&S::gain>(), "speed per force (chosen)"},
      {"max_speed", "m/s", 0.1, 0.005, 0.3, Into<&S::max_speed>(), "largest speed (chosen)"},
      {"rest_speed", "m/s", 0.01, 0.0, 0.3, Into<&S::rest_speed>(), "a slower robot is at rest (chosen)"},
  });
  return table;
}

const ParameterTable<CoverageSettings>& CoverageFieldWalkParameters() {
  using S = CoverageSettings;
  static const ParameterTable<S>::Rows walk = {
      {"walk_turn_probability", "", 0.01, 0.0, 1.0, Into<&S::walk, &RandomWalkParameters::turn_probability>(),
       "chance of a new heading per tick of a robot at rest (chosen)"},
      {"walk_turn_limit", "rad", 115.0 * sim::kDegree, 0.0, sim::kPi,
       Into<&S::walk, &RandomWalkParameters::turn_limit>(),
       "largest change of heading of the walk (Buchanan's dps code)"},
  };
  static const ParameterTable<S> table(CoverageFieldParameters(), walk);
  return table;
}

ControllerFactory MakeCoverageRobots(const CoverageSettings& settings) {
  return {[settings](const ControllerContext&) { return std::make_unique<CoverageController>(settings); }};
}

}  // namespace

const ScenarioInfo& CoverageScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<CoverageScenario>(
      CoverageScenarioParameters(),
      {
          .name = "coverage",
          .description = "robots spread from a corner until they see as much of the arena as they can",
          .default_controller = "coverage-field",
          .style = {.lost = "stuck", .lost_is_failure = false, .annotations = kCoverageAnnotations},
          .metrics = kCoverageMetrics,
          .failures = {.axes = {{"hole_x", -1.5, 0.5, 6}, {"hole_y", -1.5, 0.5, 6}},
                       .place = {{"hole_x", "hole_y", 0.5}}},  // chosen: a quarter of where random cases fail
          .failure_types = CoverageFailureTypes(),
      });
  return info;
}

std::span<const ControllerInfo> CoverageControllers() {
  static const std::array rows = {
      ControllerRow("coverage-field", "coverage",
                    "neighbours and obstacles push a robot until it is at rest (after Howard et al. 2002)",
                    CoverageFieldParameters(), MakeCoverageRobots),
      ControllerRow("coverage-field-walk", "coverage", "the same, but a robot at rest walks at random",
                    CoverageFieldWalkParameters(), MakeCoverageRobots),
  };
  return rows;
}

}  // namespace gauntlet::controllers::coverage
