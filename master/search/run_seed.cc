#include "master/search/run_seed.h"

#include "master/search/search_table.h"
#include "sim/random/random_stream.h"

namespace gauntlet::master {

std::uint64_t RunSeed(const Experiment& experiment, IndividualId individual, std::uint32_t evaluation,
                      std::uint32_t replicate) {
  constexpr std::uint32_t kSearch = 1;  // every search counts as the first of its campaign
  return sim::DeriveSeed(experiment.seed, RowOf(experiment).purpose, kSearch, individual, evaluation,
                         replicate);
}

}  // namespace gauntlet::master
