// Where a master listens: judged before anything is made for it, and told to its workers.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet {

enum class ListenOn { kThisMachine, kAnotherMachine };

// Whether `endpoint` has a form that workers can be served on: tcp://ADDRESS:PORT with an IPv4 address, the
// name of a network interface (which must be there, unless it is another machine that is to listen), or *
// (all interfaces), and a port from 1 to 65535 or * (any free one); or ipc://PATH. kInvalidInput names the
// endpoint, what is wrong and what would be right. Nothing is opened.
Status CheckBindEndpoint(const std::string& endpoint, ListenOn where = ListenOn::kThisMachine);

// Listens there for a moment. What the system refuses (an address in use, or not of this machine) is an error
// then, and not only after a campaign was made.
Status TryToListen(const std::string& endpoint);

// `bound`: what the socket says of itself. An address that means all interfaces (tcp://0.0.0.0:PORT,
// tcp://[::]:PORT) becomes one endpoint for each IPv4 address of this machine, loopback only when there is no
// other, then one with its host name; anything else stays as it is.
std::vector<std::string> ReachableEndpoints(const std::string& bound);

}  // namespace gauntlet
