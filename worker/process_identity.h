// Who this process is, so that a master on the same machine can watch it.
#pragma once

#include "proto/messages.h"

namespace gauntlet::worker {

// Sets pid, boot_id, pid_namespace and start_time of a hello to this process'. What /proc does not tell stays
// empty: then the master has only heartbeats to go by.
void IdentifyThisProcess(Hello& hello);

}  // namespace gauntlet::worker
