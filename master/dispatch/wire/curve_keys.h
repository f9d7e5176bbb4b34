// Keys of CurveZMQ (RFC 26): who may speak to a campaign's master, and how it is kept from others' ears.
#pragma once

#include <string>

namespace gauntlet {

// Curve25519 keys as ZeroMQ writes them: 40 characters of Z85.
struct CurveKeyPair {
  std::string public_key;
  std::string secret_key;
  bool operator==(const CurveKeyPair&) const = default;
};

struct CampaignKeys {
  CurveKeyPair master;
  CurveKeyPair worker;  // shared by all workers of the campaign
};

// From the operating system's random numbers.
CurveKeyPair NewCurveKeyPair();

}  // namespace gauntlet
