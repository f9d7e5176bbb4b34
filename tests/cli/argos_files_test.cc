#include "cli/argos_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const ArgosFilesOptions kLightFlocking = {.controller_file =
                                              GAUNTLET_SOURCE_DIR "/argos/example/light_flocking.argos"};

TEST(ControllersWithParameters, HaveTheValuesOfTheRunInTheirParams) {
  sim::RunSpec spec;
  spec.scenario = "light-flocking";
  spec.controller_parameters = {{"flocking.target_distance", 60.5}, {"wheel_turning.max_speed", 12.0}};
  EXPECT_THAT(ControllersWithParameters(spec, kLightFlocking).value(),
              AllOf(StartsWith("<controllers>"), HasSubstr("target_distance=\"60.5\" gain=\"1000\""),
                    HasSubstr("max_speed=\"12\""), EndsWith("</controllers>\n")));
}

TEST(ControllersWithParameters, NeedAFile) {
  EXPECT_EQ(ControllersWithParameters({}, {}).value(), "");
  EXPECT_THAT(ControllersWithParameters({}, {.controller_file = "/nowhere"}).error().message,
              HasSubstr("--controller-file cannot open /nowhere"));
}

}  // namespace
}  // namespace gauntlet
