// The searches of a new campaign: one, or those that --sweep and --seeds ask for.
#pragma once

#include <vector>

#include "base/result.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

// The experiment of `options` and `extra`, once for each combination of the values of the sweeps
// ("key=a,b,c", the last varies fastest) and each of the seeds ("1..20" or "1,5,9"; "" = the experiment's
// own); all of them valid and different. A single one has no settings. Errors name the option and what would
// be right; refused are also a search of given cases that `extra` does not choose, two such whose runs would
// be the same, and settings that none of the searches reads.
Result<std::vector<SearchPlan>> PlanSearches(const ExperimentOptions& options,
                                             const std::vector<ExtraSet>& extra, const SweepOptions& sweep);

// Says which noise changes nothing, since no robot of the swarm has the device, and which windows of
// requirements reach beyond a run.
void TellOfIdleSettings(CommandContext& context, const std::vector<SearchPlan>& searches);

}  // namespace gauntlet
