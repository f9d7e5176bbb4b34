// A campaign opened to be read, whether a master serves it or not.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/campaign_ownership.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

struct StoredCampaign {
  CampaignView view;
  std::vector<SearchPlan> plans;
  std::string being_written;  // a sentence that says so; "" when no master lives
};

// Its rows were held against one another (CheckStored, but for specs and results in full). `dir` is named in
// sentences as it was given. Errors: those of ViewCampaign, ReadSearchPlans and CheckStored.
Result<StoredCampaign> OpenStoredCampaign(const std::string& dir);

}  // namespace gauntlet
