// Golden hashes: numbers that say whether two builds compute the same runs of a controller.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet::proto {

using GoldenHashes = std::map<std::string, std::uint64_t>;  // by the controller's name

// A line each, "flocking 00112233aabbccdd\n", in the order of the names: what `gauntlet-worker --golden`
// prints and a campaign stores.
std::string WriteGoldenHashes(const GoldenHashes& hashes);
// Error (kCorrupt): a line of another form, or none.
Result<GoldenHashes> ReadGoldenHashes(const std::string& text);

// The controllers, in the order of their names.
std::vector<std::string> ControllersOf(const GoldenHashes& hashes);

// A controller of which one side has another hash, or none.
struct GoldenDifference {
  std::string controller;
  std::uint64_t needed = 0;
  std::optional<std::uint64_t> offered;  // none: that build does not have the controller
};
// The first of `needed` that `offered` does not have alike; what else is offered does not matter.
std::optional<GoldenDifference> FirstDifference(const GoldenHashes& needed, const GoldenHashes& offered);

}  // namespace gauntlet::proto
