// How many different failures the confirmed cases of a campaign are.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "study/questions/confirmations.h"

namespace gauntlet {

// The toughest first. `program`: how the commands begin that show one; `link`: where a page tells of a run.
Table DistinctFailuresTable(const std::vector<DistinctFailure>& failures, const std::string& program = "",
                            const std::function<std::string(RunId)>& link = nullptr);
// "8 distinct failures (7 confirmed) ..." with the `most` toughest. Nothing when no case was confirmed.
Section TellDistinctFailures(const CampaignAnswers& answers, std::size_t most,
                             const std::string& program = "",
                             const std::function<std::string(RunId)>& link = nullptr);

}  // namespace gauntlet
