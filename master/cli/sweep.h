// The searches that --sweep and --seeds ask for.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/cli/options.h"
#include "master/directory/search_plans.h"

namespace gauntlet::master {

// The experiment of `options` and `size`, once for each combination of the values of `sweeps` ("key=a,b,c",
// the last varies fastest) and each of `seeds` ("1..20" or "1,5,9"; "" = the experiment's own); all of them
// valid. A single one has no settings. Errors name the option and what would be right.
Result<std::vector<SearchPlan>> PlanSearches(const ExperimentOptions& options, const SizeOptions& size,
                                             const std::vector<std::string>& sweeps,
                                             const std::string& seeds);

}  // namespace gauntlet::master
