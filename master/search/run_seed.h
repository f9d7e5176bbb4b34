// Which seed a run of a search has.
#pragma once

#include <cstdint>

#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"

namespace gauntlet::master {

// The seed of replicate 0, 1, ... of an evaluation of an individual. It depends on these numbers and the
// experiment's seed alone, so a search of a sweep has the seeds that it would have in a campaign of its own.
std::uint64_t RunSeed(const Experiment& experiment, IndividualId individual, std::uint32_t evaluation,
                      std::uint32_t replicate);

}  // namespace gauntlet::master
