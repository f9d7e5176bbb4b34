// How far a campaign that is being served has come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "master/dispatch/evaluation_backend.h"
#include "master/search/search_algorithm.h"

namespace gauntlet::master {

// What a person wants to see while it runs. Of several searches, generations and counts are sums.
struct CampaignProgress {
  SearchProgress search;
  std::size_t searches = 1;
  std::size_t searches_finished = 0;
  std::uint64_t runs_done = 0;     // stored, earlier sessions included
  std::uint64_t runs_planned = 0;  // 0 = unknown
  double runs_per_second = 0.0;    // over the last seconds
  double best_fitness = 0.0;       // of the population at the last complete generation; NaN before the first
  double mean_fitness = 0.0;       // of several searches: the mean over them
  std::uint64_t total_failures = 0;  // runs so far
  std::uint64_t runs_failed = 0;     // verdict other than completed
  WorkerStatistics workers;
  double elapsed_seconds = 0.0;             // of this session
  std::optional<double> remaining_seconds;  // at the present rate
};

// Several searches are as far as they are together, and have finished when all have.
inline void Add(const SearchProgress& one, SearchProgress& sum) {
  sum.generation += one.generation;
  sum.generations += one.generations;
  sum.evaluations_done += one.evaluations_done;
  sum.evaluations_planned += one.evaluations_planned;
  sum.finished = sum.finished && one.finished;
}

}  // namespace gauntlet::master
