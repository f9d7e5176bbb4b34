#include "tests/golden/argos/motion_validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/golden/argos/sensor_validation.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

class MotionScene : public testing::TestWithParam<std::string> {};

void ExpectAgreement(const std::vector<ValidationRow>& rows) {
  EXPECT_FALSE(rows.empty()) << "the file is missing";
  for (const ValidationRow& row : rows) {
    EXPECT_TRUE(row.ok()) << row.quantity << ": error " << row.error << " of " << row.values
                          << " values, tolerance " << row.tolerance;
  }
}

TEST_P(MotionScene, AgreesWithArgos) {
  ExpectAgreement(ValidateMotion(GetParam()));
}

TEST_P(MotionScene, AgreesWithArgosInBox2d) {
  ExpectAgreement(ValidateMotion(GetParam(), sim::PhysicsKind::kBox2d));
}

INSTANTIATE_TEST_SUITE_P(Argos, MotionScene, testing::ValuesIn(MotionScenes()),
                         [](const auto& scene) { return scene.param; });

TEST(ValidationRow, FailsAboveItsToleranceAndWithoutValues) {
  EXPECT_TRUE(
      (ValidationRow{.file = "f", .quantity = "q", .tolerance = 0.1, .error = 0.1, .values = 1}.ok()));
  EXPECT_FALSE(
      (ValidationRow{.file = "f", .quantity = "q", .tolerance = 0.1, .error = 0.1000001, .values = 1}.ok()));
  EXPECT_FALSE(
      (ValidationRow{.file = "f", .quantity = "q", .tolerance = 0.1, .error = 0.0, .values = 0}.ok()));
}

// The page has a line for every quantity of every file, with the tolerance that is judged.
TEST(ValidationPage, StatesEveryToleranceThatIsJudged) {
  std::ifstream file(GAUNTLET_SOURCE_DIR "/docs/validation.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto expect_line = [&](const ValidationRow& row) {
    char line[200];
    std::snprintf(line, sizeof line, "| %s | %s | %d | %d | %.1e |", row.file.c_str(), row.quantity.c_str(),
                  row.values, row.edges, row.tolerance);
    EXPECT_NE(page.find(line), std::string::npos) << line;
  };
  for (const std::string& sweep : SensorSweeps()) {
    for (const ValidationRow& row : ValidateSensorSweep(sweep)) expect_line(row);
  }
  for (const std::string& scene : MotionScenes()) {
    for (const ValidationRow& row : ValidateMotion(scene)) expect_line(row);
  }
}

// No file that was measured is forgotten.
TEST(ValidationPage, EveryMeasuredFileIsCompared) {
  std::vector<std::string> scenes = MotionScenes();
  std::vector<std::string> sweeps = SensorSweeps();
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const auto& entry :
       std::filesystem::directory_iterator(GAUNTLET_SOURCE_DIR "/tests/golden/argos/motion")) {
    EXPECT_TRUE(has(scenes, entry.path().stem().string())) << entry.path();
  }
  for (const auto& entry :
       std::filesystem::directory_iterator(GAUNTLET_SOURCE_DIR "/tests/golden/argos/sensors")) {
    EXPECT_TRUE(has(sweeps, entry.path().filename().string())) << entry.path();
  }
}

}  // namespace
}  // namespace gauntlet
