// What is known of how often cases fail, for people and scripts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/questions/campaign_answers.h"

namespace gauntlet {

// A line for each of the first `most` cases, and a sentence that counts all.
std::string ConfirmationsText(const std::vector<Confirmation>& confirmations, std::size_t most = 1000000);
// [{run, case, k, n, interval: [lo, hi], verdict, message}]; run is null for a case from a file.
nlohmann::ordered_json ConfirmationsJson(const std::vector<Confirmation>& confirmations);

// "8 distinct failures (7 confirmed) ..." and a line for each of the toughest, with a command that shows it.
// "" when there is nothing to tell.
std::string DistinctFailuresText(const CampaignAnswers& answers, const std::string& program);

}  // namespace gauntlet
