// Who may work for a campaign.
#pragma once

#include <string>

#include "master/dispatch/dispatch_options.h"
#include "proto/messages.h"

namespace gauntlet::master {

// Why the worker that says this may not work for this campaign, as a sentence for its log and ours; "" when
// it may.
std::string ReasonToRefuse(const proto::Hello& hello, const CampaignIdentity& identity);

}  // namespace gauntlet::master
