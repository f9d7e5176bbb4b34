// The keys of an experiment that say what is wrong with robots.
#pragma once

#include <string_view>
#include <vector>

#include "search/experiment/schema.h"

namespace gauntlet {

// "faults": those of robots that are named.
Key FaultsKey();
// "random_faults.NAME": those of robots that are drawn.
std::vector<Key> RandomFaultKeys();
// "noise.DEVICE.NAME".
std::vector<Key> NoiseKeys();

// Whether the key says something of robots that are drawn, and none is.
bool NobodyIsDrawn(const Experiment& experiment, std::string_view path);

}  // namespace gauntlet
