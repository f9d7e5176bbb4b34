#include "tests/golden/argos/motion_validation.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

class MotionScene : public testing::TestWithParam<std::string> {};

TEST_P(MotionScene, AgreesWithArgos) {
  const std::vector<ValidationRow> rows = ValidateMotion(GetParam());
  EXPECT_FALSE(rows.empty()) << GetParam() << " is missing";
  for (const ValidationRow& row : rows) {
    EXPECT_TRUE(row.ok()) << row.quantity << ": error " << row.error << " of " << row.values
                          << " values, tolerance " << row.tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(Argos, MotionScene, testing::ValuesIn(MotionScenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace gauntlet
