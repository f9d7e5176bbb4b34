// What is known of how often cases fail, for people and scripts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/questions/campaign_answers.h"

namespace gauntlet {

// "8 distinct failures (7 confirmed) ..." and a line for each of the `most` toughest, with a command that
// shows it. "" when there is nothing to tell.
std::string DistinctFailuresText(const CampaignAnswers& answers, const std::string& program,
                                 std::size_t most = 20);
// A list of {what, confirmed, k, n, interval, cases: [...], example: {campaign, run}, smallest: {case,
// obstacles, k, n, file}}, in the same order; smallest is null until one of the cases is minimised.
nlohmann::ordered_json DistinctFailuresJson(const CampaignAnswers& answers);

}  // namespace gauntlet
