#include "tests/golden/argos/sensor_validation.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

class SensorSweep : public testing::TestWithParam<std::string> {};

TEST_P(SensorSweep, AgreesWithArgos) {
  const std::vector<ValidationRow> rows = ValidateSensorSweep(GetParam());
  EXPECT_FALSE(rows.empty()) << GetParam() << " is missing";
  for (const ValidationRow& row : rows) {
    EXPECT_TRUE(row.ok()) << row.quantity << ": error " << row.error << " of " << row.values
                          << " values, tolerance " << row.tolerance;
    EXPECT_LE(row.edges * 10, row.values) << row.quantity << ": too many values are left out as edges";
  }
}

INSTANTIATE_TEST_SUITE_P(Argos, SensorSweep, testing::ValuesIn(SensorSweeps()),
                         [](const auto& sweep) { return sweep.param.substr(0, sweep.param.find('.')); });

}  // namespace
}  // namespace gauntlet
