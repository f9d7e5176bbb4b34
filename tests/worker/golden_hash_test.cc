// Covers: base/system/instruction_set.cc, worker/run_executor.cc
#include "worker/golden_hash.h"

#include <gtest/gtest.h>

namespace gauntlet::worker {
namespace {

TEST(GoldenHashOf, AControllerOfAnyScenarioIsThatOfItsRunsInTheFirst) {
  const controllers::ScenarioInfo& scenario = controllers::Scenarios().front();
  const controllers::ControllerInfo* controller = controllers::FindController(scenario.default_controller);
  ASSERT_NE(controller, nullptr);
  controllers::ControllerInfo of_any = *controller;
  of_any.scenario = controllers::kAnyScenario;
  EXPECT_EQ(GoldenHashOf(of_any), GoldenHashOf(*controller));
}

}  // namespace
}  // namespace gauntlet::worker
