// An evolution on a machine that it shares with somebody who does not wish it well.
#pragma once

#include <string>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

// `evolve` with two workers whose runs take 200 ms more, while another user sends `each` forged messages of
// every kind to its port (stranger.h). Expects the result of an undisturbed campaign, and that it lasted
// longer than the attack.
void EvolveUnderForgery(const SmallCampaign& campaign, const std::string& dir, int each);

}  // namespace gauntlet::testing_support
