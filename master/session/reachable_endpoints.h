// Where workers on other machines find a socket that was bound here.
#pragma once

#include <string>
#include <vector>

namespace gauntlet::master {

// `bound`: what the socket says of itself. An address that means all interfaces (tcp://0.0.0.0:PORT,
// tcp://[::]:PORT) becomes one endpoint for each IPv4 address of this machine, loopback only when there is no
// other, then one with its host name; anything else stays as it is.
std::vector<std::string> ReachableEndpoints(const std::string& bound);

}  // namespace gauntlet::master
