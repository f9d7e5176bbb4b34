// What came of the files given to `evaluate`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "master/dispatch/evaluation_backend.h"
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
// The rule's name in front of "no-path: there is ..."; "" when the message does not begin with one.
std::string RuleOf(std::string_view message);
// "completed", "refused", "crashed", "hung", "out-of-memory", "invalid-command".
std::string_view NameOf(sim::Verdict verdict);

}  // namespace gauntlet::master
