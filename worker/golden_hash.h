// The golden hashes of this build: equal where its runs are computed equally.
#pragma once

#include <string>
#include <vector>

#include "proto/golden_hashes.h"

namespace gauntlet::worker {

// Of every built-in controller that is named, or of all when none is: a hash over whole RunResults of it in a
// few short fixed cases, and over a probe of our own trigonometry and random numbers. Equal on every machine
// and for every compiler. A worker says them in its hello; a campaign refuses workers that differ in a
// controller it uses. Takes some ten milliseconds for each controller; a name that no controller bears is
// left out.
proto::GoldenHashes GoldenHashes(const std::vector<std::string>& controllers = {});

}  // namespace gauntlet::worker
