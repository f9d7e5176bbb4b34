// The example of light flocking once more, as a plug-in: its runs must be those of the built-in one.
#include "controllers/examples/light_flocking_controller.h"
#include "sdk/plugin.h"

namespace {

namespace controllers = gauntlet::controllers;
using controllers::Into;
using Settings = controllers::light_flocking::LightFlockingSettings;

controllers::ControllerFactory MakeTwins(const Settings& settings) {
  return {.create =
              [settings](const controllers::ControllerContext&) {
                return std::make_unique<controllers::light_flocking::LightFlockingController>(settings);
              },
          .traits = {.link_range = settings.cutoff * settings.target_distance}};
}

// Names, defaults and ranges of the built-in one.
std::vector<controllers::ControllerInfo> Twins() {
  using gauntlet::sim::kDegree;
  using S = Settings;
  static const controllers::ParameterTable<Settings> table({
      {"target_distance", "m", 0.75, 0.2, 3.0, Into<&S::target_distance>(), "distance that flockmates keep"},
      {"gain", "m^2/s", 0.1, 0.0, 10.0, Into<&S::gain>(), "strength of the force"},
      {"exponent", "", 2, 1, 6, Into<&S::exponent>(), "exponent of the force"},
      {"cutoff", "", 1.8, 1.0, 5.0, Into<&S::cutoff>(), "in target distances"},
      {"max_speed", "m/s", 0.1, 0.005, 0.3, Into<&S::max_speed>(), "speed of a wheel"},
      {"light_share", "", 0.25, 0.0, 1.0, Into<&S::light_share>(), "pull of the light"},
      {"no_turn", "rad", 10.0 * kDegree, 0.0, 4.0, Into<&S::no_turn>(), "up to here straight on"},
      {"soft_turn", "rad", 70.0 * kDegree, 0.0, 4.0, Into<&S::soft_turn>(), "down to here an arc"},
      {"hard_turn", "rad", 90.0 * kDegree, 0.1, 4.0, Into<&S::hard_turn>(), "beyond it on the spot"},
  });
  return {controllers::ControllerRow("twin", "light-flocking", "light flocking from a library", table,
                                     MakeTwins)};
}

}  // namespace

GAUNTLET_PLUGIN(Twins)
