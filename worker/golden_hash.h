// The golden hashes of this build: equal where its runs are computed equally.
#pragma once

#include "proto/golden_hashes.h"

namespace gauntlet::worker {

// Of every built-in controller: a hash over whole RunResults of it in a few short fixed cases, and over a
// probe of our own trigonometry and random numbers. Equal on every machine and for every compiler. A worker
// says them in its hello; a campaign refuses workers that differ in a controller it uses. Takes some ten
// milliseconds.
proto::GoldenHashes GoldenHashes();

}  // namespace gauntlet::worker
