// Campaigns of which some workers lie.
#pragma once

#include <string>
#include <vector>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/liar.h"

namespace gauntlet::testing_support {

// A master, these liars, and as many honest workers, which begin when the liars have joined. Expects the
// result of a campaign without liars, and that those who lie (not those who are merely slow) are named as
// quarantined when they had the time to show what they are: `all_named`.
void EvolveWithLiars(const SmallCampaign& campaign, const std::string& dir, const std::vector<Lie>& liars,
                     bool all_named);

}  // namespace gauntlet::testing_support
