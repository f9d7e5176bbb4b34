#include "controllers/site_selection/site_selection_registry.h"

#include <array>

namespace gauntlet::controllers::site_selection {
namespace {

const std::vector<MetricInfo> kSiteSelectionMetrics = {
    {"better_share", "", {}, "share of the robots that are for the better site, mean of the last 30 s"},
    {"consensus", "yes/no", {}, "whether at least 90 % of the robots are for the same site at the end", true},
    {"decision_time", "s", kNotMeasured, "from when on at least 90 % were for the same site for 60 s"},
    {"wrong", "yes/no", {}, "whether most robots are for the worse site at the end"},
    {"better_side", "", {}, "1 = site A, towards the light, is better; 2 = site B is"},
    {"visited_better", "", {}, "share of the robots that ever came to the better site", true},
    {"visited_worse", "", {}, "share of the robots that ever came to the worse site", true},
    {"trips_better", "", {}, "arrivals at the better site per robot"},
    {"trips_worse", "", {}, "arrivals at the worse site per robot"},
    {"travel_better", "s", kNotMeasured, "mean way from the nest to the better site", true},
    {"travel_worse", "s", kNotMeasured, "mean way from the nest to the worse site", true},
    {"travelling", "", {}, "share of the robots on the way to a site or back at the end", true},
    {"stuck_robots", "", {}, "robots that kept within 5 cm for the last minute", true},
    {"opinion_changes", "", {}, "changes of opinion of all robots"},
};

const std::vector<sim::AnnotationStyle> kSiteSelectionAnnotations = {
    {"area", "nest", sim::Mark::kArea, "nest, site A (right) and site B (left)"},
    {"area", "site A", sim::Mark::kArea, ""},
    {"area", "site B", sim::Mark::kArea, ""},
};

ControllerFactory MakeSiteSelectors(const SiteSelectionSettings& settings) {
  return {[settings](const ControllerContext& context) {
    return std::make_unique<SiteSelectionController>(settings, context);
  }};
}

}  // namespace

const ParameterTable<SiteSelectionScenarioSettings>& SiteSelectionScenarioParameters() {
  using S = SiteSelectionScenarioSettings;
  static const ParameterTable<S> table({
      {"robots", "", 20, 1, 100, Into<&S::robots>(),
       "robots under test; a test case may override it (chosen)"},
      {"time_limit", "s", 900, 1, 3600, IntoTicks<&S::tick_limit>(), "length of a run at most (chosen)"},
      {"nest_half_width", "m", 0.8, 0.2, 5.0, Into<&S::nest_half_width>(),
       "the nest reaches so far to either side of the middle (chosen)"},
      {"site_depth", "m", 1.0, 0.3, 5.0, Into<&S::site_depth>(),
       "a site reaches so far from the wall's centre line (chosen)"},
      {"light_distance", "m", 10.0, 0.1, 20.0, Into<&S::light_distance>(),
       "of the light from the wall behind site A, beyond it (calibrated: in the empty arena both sides are "
       "alike)"},
      {"worse_quality", "", 0.5, 0.05, 1.0, Into<&S::worse_quality>(),
       "quality of the worse site; the better one has 1 (chosen)"},
      {"better_side", "", 0, 0, 2, Into<&S::better_side>(),
       "1 = site A, towards the light, is better, 2 = site B, 0 = drawn from the run's seed (chosen)"},
      {"radio_range", "m", 3.0, 0.3, 10.0, Into<&S::radio_range>(), "how far robots are heard (chosen)"},
      {"open_share", "", 0.75, 0.0, 1.0, Into<&S::open_share>(),
       "of the empty arena that obstacles must leave connected with the nest (chosen)"},
  });
  return table;
}

const ParameterTable<SiteSelectionSettings>& SiteSelectionParameters() {
  using S = SiteSelectionSettings;
  static const ParameterTable<S> table({
      {"speed", "m/s", 0.1, 0.005, 0.3, Into<&S::speed>(), "forward speed (chosen)"},
      {"survey_time", "s", 10.0, 0.1, 600.0, Into<&S::survey_time>(), "mean time at a site (chosen)"},
      {"tell_time", "s", 60.0, 0.1, 600.0, Into<&S::tell_time>(),
       "mean time of telling an opinion, for quality 1 (chosen)"},
      {"tell_chance", "", 0.1, 0.001, 1.0, Into<&S::tell_chance>(),
       "chance per tick that a robot tells its opinion (chosen)"},
      {"group", "", 5, 1, 25, Into<&S::group>(),
       "the opinions of so many others count, those heard last (chosen)"},
      {"listen_time", "s", 5.0, 0.1, 600.0, IntoTicks<&S::listen_ticks>(),
       "opinions heard so long before the decision count (chosen)"},
  });
  return table;
}

const ParameterTable<SiteSelectionSettings>& ImprovedSiteSelectionParameters() {
  using S = SiteSelectionSettings;
  static const ParameterTable<S> table(
      SiteSelectionParameters(), {
                                     {"patience", "s", 5.0, 0.1, 600.0, IntoTicks<&S::patience>(),
                                      "a robot on its way that avoided for so long longer than it did not "
                                      "follows the obstacle (chosen)"},
                                     {"detour_time", "s", 15.0, 0.1, 600.0, IntoTicks<&S::detour_ticks>(),
                                      "for so long, on a side that is drawn (chosen)"},
                                 });
  return table;
}

const ScenarioInfo& SiteSelectionScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<SiteSelectionScenario>(
      SiteSelectionScenarioParameters(),
      {
          .name = "site-selection",
          .description = "robots decide together which of two sites is better (Valentini et al. 2016)",
          .default_controller = "site-selection",
          .style = {.lost = "for the worse site", .annotations = kSiteSelectionAnnotations},
          .metrics = kSiteSelectionMetrics,
          .failures = {.axes = {{"visited_better", 0.0, 1.0, 3}, {"stuck_robots", 0.0, 10.0, 3}}},
          .failure_types = SiteSelectionFailureTypes(),
      });
  return info;
}

std::span<const ControllerInfo> SiteSelectionControllers() {
  static const std::array rows = {
      ControllerRow(
          "site-selection", "site-selection",
          "explores the site of its opinion, tells it the longer the better the site is, then takes "
          "the majority's (Valentini et al. 2016)",
          SiteSelectionParameters(), MakeSiteSelectors),
      ControllerRow("site-selection-improved", "site-selection",
                    "the same; a robot that is held up follows the obstacle for a while",
                    ImprovedSiteSelectionParameters(), MakeSiteSelectors),
  };
  return rows;
}

}  // namespace gauntlet::controllers::site_selection
