// What a fit is held against, as people write it: a TOML file of targets and conditions, whose measured
// values may stand in CSV files.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"
#include "sim/arena/test_case.h"

namespace gauntlet {

struct FitTargets {
  std::string text;                  // fit.targets
  std::vector<sim::TestCase> cases;  // that targets are about and that are not generated
  std::vector<std::string> notices;  // what a reader has to know
};

// Tables [[target]] and [[require]]; files that they name stand beside the file. `experiment`: that is
// fitted, whose swarm has to fit into the cases. Error: begins with the file's place.
Result<FitTargets> ReadTargetFile(const std::string& path, const Experiment& experiment);

}  // namespace gauntlet
