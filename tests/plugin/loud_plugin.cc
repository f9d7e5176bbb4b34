// A plug-in that prints when it is loaded: every run of it has to load it anew.
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sdk/plugin.h"

namespace {

namespace sim = gauntlet::sim;
namespace controllers = gauntlet::controllers;

const bool kLoaded = std::fputs("loaded\n", stderr) >= 0;

// The robots of a run are counted by one static.
int robots = 0;

class Robot : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override { return sim::Device::kWheels; }
  void Step(const sim::ControlStep& /*step*/) override {}
};

struct NoSettings {};

std::vector<controllers::ControllerInfo> Rows() {
  static const controllers::ParameterTable<NoSettings> table({});
  return {controllers::ControllerRow(
      "loud", controllers::kAnyScenario, "prints when it is loaded", table, +[](const NoSettings&) {
        return controllers::ControllerFactory{[](const controllers::ControllerContext& context) {
          if (robots++ != context.robot) throw std::runtime_error("statics of another run");
          return std::make_unique<Robot>();
        }};
      })};
}

}  // namespace

GAUNTLET_PLUGIN(Rows)
