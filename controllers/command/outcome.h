// What a program said of its run.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "controllers/command/definition.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers::command {

// Files in the run's folder, beside those that the definition names.
inline constexpr const char* kStdoutFile = ".gauntlet-stdout";
inline constexpr const char* kStderrFile = ".gauntlet-stderr";

// Whether what it printed says that the case cannot begin: the line that says so.
std::optional<std::string> RefusedBy(const Definition& definition, const std::string& folder);

// Of a program that has ended with exit code 0 in this folder: verdict, metrics, fitness, failure and, where
// the definition names one, the trajectory. Error: what is missing or no number, in one line that does not
// depend on the machine; the run counts as crashed.
Result<sim::RunResult> OutcomeOf(const Definition& definition, const sim::RunSpec& spec,
                                 const std::string& folder);

}  // namespace gauntlet::controllers::command
