// Runs of a campaign that are simulated again to be seen.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/figures/run/run_figure.h"
#include "base/result.h"
#include "master/campaign/replay.h"
#include "report/figures/campaign_facts.h"
#include "report/figures/run_map.h"
#include "study/questions/distinct_failures.h"

namespace gauntlet {

struct ShownRun {
  ReplayReport report;  // `stored` is always there
  // Why it cannot be shown as it was: it did not end as stored, or does not read back; "" = it was reproduced
  // bit for bit.
  std::string trouble;
  analysis::RunFigure figure;  // empty when the stored run does not read back
};

// At most `most` runs that are worth a look: of the toughest cases of the distinct failures, of cases that
// were made smaller, of an archive's failures from the smallest on, the case that commands point at, the
// toughest of each field of the maps,
// the first map first, then the toughest run of the toughest cases. Each once, in this order.
std::vector<RunId> RunsToShow(const CampaignFacts& facts, const std::vector<RunMap>& maps, std::size_t most);

// Simulates them on all cores. Errors: those of ReadRuns; the worker program cannot be run.
Result<std::vector<ShownRun>> ShowRuns(const CampaignFacts& facts, const std::vector<RunId>& ids);
// The same of the typical runs of distinct failures, which stand in the campaigns that confirmed their cases.
Result<std::vector<ShownRun>> ShowTypicalRuns(const CampaignFacts& facts,
                                              const std::vector<const DistinctFailure*>& failures);
// The toughest of the runs in which minimising has simulated what is left of each case, by
// SmallestLayout::run; without those of which none is there.
Result<std::map<RunId, ShownRun>> ShowSmallest(const CampaignFacts& facts,
                                               const std::vector<const SmallestLayout*>& layouts);

}  // namespace gauntlet
