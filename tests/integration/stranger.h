// Another user of the machine, who may not read access.json, at the port of a master.
#pragma once

#include <string>

namespace gauntlet::testing_support {

// Only root can be another user.
bool CanBeAnotherUser();

// Sends `each` messages of every kind to the master of the campaign in `dir`: hellos with all that a stranger
// can find out (the campaign's id, version and golden hashes are no secrets) followed by failures, results,
// heartbeats, drains and goodbyes for the leases that such a master gives, and raw bytes; all of them in
// plaintext, with unknown keys to the right server key, and with a wrong server key. It runs in a process of
// the user nobody. "" when everything was sent and nobody ever answered; otherwise what was not as expected.
std::string ForgeAsAnotherUser(const std::string& dir, int each);

}  // namespace gauntlet::testing_support
