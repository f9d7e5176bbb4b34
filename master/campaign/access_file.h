// access.json: how workers find the master of a campaign.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace gauntlet::master {

struct AccessInfo {
  std::string campaign;                // id, hex
  std::uint64_t epoch = 0;             // the master's start number
  std::vector<std::string> endpoints;  // ZeroMQ addresses, "tcp://127.0.0.1:41234"
};

// Writes the file for its owner alone (0600), at once and whole.
Status WriteAccessFile(const std::string& path, const AccessInfo& info);

// Removes it unless a newer master has written its own meanwhile. A missing file is no error.
Status RemoveAccessFile(const std::string& path, std::uint64_t epoch);

}  // namespace gauntlet::master
