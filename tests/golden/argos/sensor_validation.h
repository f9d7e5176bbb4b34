// Every sensor sweep measured in ARGoS, against this simulator's sensors.
#pragma once

#include <string>
#include <vector>

#include "tests/golden/argos/validation.h"

namespace gauntlet {

// File names below tests/golden/argos/sensors.
std::vector<std::string> SensorSweeps();
// One row per quantity of the file; none when the file is missing. Errors are shares of full scale, except
// counts of blobs and messages, which must be equal.
std::vector<ValidationRow> ValidateSensorSweep(const std::string& file);

}  // namespace gauntlet
