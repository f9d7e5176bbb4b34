// What `confirm` and `minimise` have found out about a campaign's cases.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "study/questions/confirmations.h"

namespace gauntlet {

struct CampaignAnswers {
  std::vector<Confirmation> confirmations;
  std::vector<SmallestLayout> smallest_layouts;
};
// Of the campaign in `dir`.
Result<CampaignAnswers> ReadAnswers(const std::string& dir);

}  // namespace gauntlet
