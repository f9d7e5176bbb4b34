// How many different failures the confirmed cases of a campaign are, in words.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "study/questions/distinct_failures.h"

namespace gauntlet {

// The toughest first, of one grouping or of several. `program`: how the commands begin that show one; `link`:
// where a page tells of a run.
Table DistinctFailuresTable(const std::vector<const DistinctFailure*>& failures,
                            const std::string& program = "",
                            const std::function<std::string(RunId)>& link = nullptr);
// [{feature, agreement, used, distinct, mixed}]: how far failures can be told apart.
Table FailureGroupingsTable(const DistinctFailures& distinct);
// A section for each grouping: "3 distinct failures by what happens, among 31 failing cases", with the `most`
// toughest; and one for cases of which too few runs failed. Nothing when no case was confirmed.
std::vector<Section> TellDistinctFailures(const CampaignAnswers& answers, std::size_t most,
                                          const std::string& program = "",
                                          const std::function<std::string(RunId)>& link = nullptr);

}  // namespace gauntlet
