// The search of a stored campaign.
#pragma once

#include <memory>

#include "base/result.h"
#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"
#include "master/store/result_store.h"

namespace gauntlet::master {

// The search as it was before its first evaluation. kCorrupt when it is a list of given test cases and the
// store does not hold them.
Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const Experiment& experiment, SearchId id,
                                                          ResultStore& store);

}  // namespace gauntlet::master
