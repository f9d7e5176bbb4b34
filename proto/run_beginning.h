// How a run begins (sim/run_start.h) as JSON: what a worker answers to a master that does not load the
// plug-in which brings the scenario.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "sim/run_start.h"

namespace gauntlet::proto {

// What is wrong with it: a number that is none, a place beyond sim::kMaxCoordinate, a negative distance, no
// robots; kInvalidInput.
Status CheckBeginning(const sim::RunBeginning& beginning);

std::string WriteBeginning(const sim::RunBeginning& beginning);
// `place` is named in errors (kInvalidInput), which are also those of CheckBeginning.
Result<sim::RunBeginning> ReadBeginning(std::string_view text, const std::string& place);

}  // namespace gauntlet::proto
