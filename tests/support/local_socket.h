// One conversation with a port of this machine, in plain bytes.
#pragma once

#include <string>

namespace gauntlet::testing_support {

// Connects, sends `request`, and returns all that comes until the other side closes; "" when nobody listens.
// Waits at most ten seconds.
std::string Converse(int port, const std::string& request);

}  // namespace gauntlet::testing_support
