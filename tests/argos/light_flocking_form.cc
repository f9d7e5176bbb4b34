#include "tests/argos/light_flocking_form.h"

#include <memory>

#include "argos/controller_adapter.h"

namespace gauntlet::argos_form {

using controllers::ControllerContext;
using controllers::ControllerFactory;

namespace {

ControllerSection Example() {
  ControllerSection section = {.label = "light_flocking_controller",
                               .devices = ControllerSection::Devices{
                                   .actuators = {"differential_steering", "leds"},
                                   .sensors = {"colored_blob_omnidirectional_camera", "footbot_light"}}};
  argos::TConfigurationNode& turning =
      section.parameters.AddChild(argos::TConfigurationNode("wheel_turning"));
  turning.SetAttributeText("max_speed", "10");
  turning.SetAttributeText("no_turn_angle_threshold", "10");
  turning.SetAttributeText("soft_turn_angle_threshold", "70");
  turning.SetAttributeText("hard_turn_angle_threshold", "90");
  argos::TConfigurationNode& flocking = section.parameters.AddChild(argos::TConfigurationNode("flocking"));
  flocking.SetAttributeText("target_distance", "75");
  flocking.SetAttributeText("gain", "1000");
  flocking.SetAttributeText("exponent", "2");
  return section;
}

}  // namespace

ControllerFactory ExampleFlockers() {
  return {.create =
              [](const ControllerContext& context) {
                return std::make_unique<ControllerAdapter>(
                    Example(), ControllerAdapter::Robot{
                                   .number = context.robot, .seed = context.seed, .start = context.start});
              },
          .traits = {.link_range = 1.35}};
}

}  // namespace gauntlet::argos_form
