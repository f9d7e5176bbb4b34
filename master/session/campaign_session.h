// Campaigns as commands know them: made, served, gone on with.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/experiment/experiment.h"
#include "master/session/session_options.h"
#include "sim/arena/test_case.h"

namespace gauntlet::master {

// Creates the campaign in `dir` (which must not exist or be empty) and runs it. `cases`: what `evaluate`
// simulates, in order (a search through given cases); empty otherwise. Errors: kInvalidInput, kInUse;
// kNoSpace and kIo when the campaign stopped and can be resumed.
Result<SessionReport> StartCampaign(const std::string& dir, const Experiment& experiment,
                                    const std::vector<sim::TestCase>& cases, const SessionOptions& options);

// Creates the campaign without running it: ResumeCampaign does. `searches`: one, or those of a sweep;
// `slurm`: the text of its slurm.toml.
Status PrepareCampaign(const std::string& dir, const std::vector<SearchPlan>& searches,
                       const std::string& slurm);

// Goes on where the campaign in `dir` was; a finished one is only summarised.
Result<SessionReport> ResumeCampaign(const std::string& dir, const SessionOptions& options);

}  // namespace gauntlet::master
