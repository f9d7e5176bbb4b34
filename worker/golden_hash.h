// The golden hashes of this build: equal where its runs are computed equally.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "controllers/registry.h"
#include "proto/golden_hashes.h"

namespace gauntlet::worker {

// A hash over whole RunResults of a built-in controller in a few short fixed cases, and over a probe of our
// own trigonometry and random numbers. Equal on every machine and for every compiler. Takes some ten
// milliseconds.
std::uint64_t GoldenHashOf(const controllers::ControllerInfo& controller);

// Of every built-in controller that is named, or of all when none is. A worker says them in its hello; a
// campaign refuses workers that differ in a controller it uses. A name that no controller bears is left out.
proto::GoldenHashes GoldenHashes(const std::vector<std::string>& controllers = {});

}  // namespace gauntlet::worker
