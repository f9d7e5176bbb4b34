// Who may work for a campaign, judged by a worker's hello.
#pragma once

#include <optional>
#include <string>

#include "master/dispatch/dispatch_options.h"
#include "proto/messages.h"

namespace gauntlet {

// Why a worker is turned away, one sentence each.
struct Refusal {
  // Names what differs, the worker's value and the campaign's: for our log, and for a peer that has proven to
  // know the campaign's key.
  std::string reason;
  // The same without any value of the campaign, for a peer that has proven nothing: it must not learn from
  // one refusal after the other how to be admitted.
  std::string for_strangers;
};

// Nothing when the worker that says this may work for this campaign.
std::optional<Refusal> ReasonToRefuse(const proto::Hello& hello, const CampaignIdentity& identity);

}  // namespace gauntlet
