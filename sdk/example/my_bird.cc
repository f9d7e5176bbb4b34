// A plug-in to copy: a bird for the flocking scenario that follows the blue prey and turns away from what is
// near.
#include <memory>
#include <vector>

#include "controllers/common/proximity.h"
#include "controllers/flocking/flocking_scenario.h"  // the colours of birds and prey
#include "sdk/plugin.h"

namespace {

namespace sim = gauntlet::sim;
using gauntlet::controllers::ControllerContext;
using gauntlet::controllers::ControllerFactory;
using gauntlet::controllers::ControllerInfo;
using gauntlet::controllers::Into;
using gauntlet::controllers::ParameterTable;

struct Settings {
  double speed = 0.0;  // m/s
  double turn = 0.0;   // rad/s for each rad of bearing
  double shyness = 0.0;
};

class MyBird : public sim::Controller {
 public:
  explicit MyBird(const Settings& settings) : settings_(settings) {}

  sim::DeviceSet Devices() const override {
    return sim::Device::kWheels | sim::Device::kLeds | sim::Device::kProximity |
           sim::Device::kOmnidirectionalCamera;
  }

  void Step(const sim::ControlStep& step) override {
    sim::Vec2 wish(0.01, 0.0);  // straight on when there is nothing to see
    for (const sim::Blob& blob : step.readings.blobs) {
      if (blob.color == gauntlet::controllers::kPreyColor) wish = blob.position;
    }
    const auto& directions = gauntlet::controllers::ProximityDirections();
    for (std::size_t i = 0; i < directions.size(); ++i)
      wish -= settings_.shyness * step.readings.proximity[i] * directions[i];
    step.actuators.beacon = gauntlet::controllers::kBirdColor;
    step.actuators.Drive(settings_.speed, settings_.turn * sim::AngleOf(wish));
  }

 private:
  Settings settings_;
};

ControllerFactory MakeMyBirds(const Settings& settings) {
  return {.create = [settings](const ControllerContext&) { return std::make_unique<MyBird>(settings); },
          .traits = {.link_range = 1.0}};
}

std::vector<ControllerInfo> MyControllers() {
  static const ParameterTable<Settings> table({
      {"speed", "m/s", 0.05, 0.0, 0.3, Into<&Settings::speed>(), "forward speed (chosen)"},
      {"turn", "1/s", 1.0, 0.0, 5.0, Into<&Settings::turn>(), "turn rate per angle to the goal (chosen)"},
      {"shyness", "m", 2.0, 0.0, 10.0, Into<&Settings::shyness>(), "weight of what is near (chosen)"},
  });
  return {gauntlet::controllers::ControllerRow("my-bird", "flocking", "follows the prey, turns from walls",
                                               table, MakeMyBirds)};
}

}  // namespace

GAUNTLET_PLUGIN(MyControllers)
