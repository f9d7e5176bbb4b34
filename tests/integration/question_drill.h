// Commands that ask something of cases (confirm, minimise, blame, check), killed on the way.
#pragma once

#include <string>
#include <vector>

#include "tests/support/process.h"

namespace gauntlet::testing_support {

// The state_hashes of the campaigns in `folder`, one for each call that asked something; sorted, because what
// the folders are called says nothing.
std::vector<std::string> StateHashesIn(const std::string& folder);

// Gives `command`, which keeps its campaigns in `folder`, three times. Twice its master is killed (SIGKILL):
// when it serves a campaign, and when it has stored something. The third time random workers and runners are
// killed until they are `worker_kills` or it has ended. Returns what it says at last.
ProcessResult AskThroughKills(const std::vector<std::string>& command, const std::string& folder,
                              int worker_kills);

}  // namespace gauntlet::testing_support
