// access.json: how workers find the master of a campaign.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet::master {

// What a worker needs of the keys; Z85.
struct AccessKeys {
  std::string server_public;
  std::string worker_public;
  std::string worker_secret;
};

struct AccessInfo {
  std::string campaign;                            // id, hex
  std::uint64_t epoch = 0;                         // the master's start number
  std::vector<std::string> endpoints;              // ZeroMQ addresses, "tcp://127.0.0.1:41234"
  std::optional<AccessKeys> curve = std::nullopt;  // none: plaintext
};

// Writes the file for its owner alone (0600), at once and whole.
Status WriteAccessFile(const std::string& path, const AccessInfo& info);

// Removes it unless a newer master has written its own meanwhile. A missing file is no error.
Status RemoveAccessFile(const std::string& path, std::uint64_t epoch);

}  // namespace gauntlet::master
