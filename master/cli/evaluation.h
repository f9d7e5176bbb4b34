// What came of the files given to `evaluate`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "master/dispatch/evaluation_backend.h"
#include "master/report/verdict_text.h"
#include "sim/run_result.h"

namespace gauntlet::master {

struct EvaluatedRun {
  RunId id = 0;
  std::uint64_t seed = 0;
  sim::RunResult result;
};

struct EvaluatedCase {
  std::string file;
  std::string error;               // why it was not simulated, "" when it was
  std::string refused_rule;        // name of the broken validity rule, "" when none
  std::vector<EvaluatedRun> runs;  // in the order of the replicates
};

// Mean over the completed runs; nothing when there is none.
std::optional<double> MeanFitness(const EvaluatedCase& evaluated);

}  // namespace gauntlet::master
