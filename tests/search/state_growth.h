// How many bytes a search saves while it goes on.
#pragma once

#include <cstdint>
#include <deque>

#include "tests/search/toy_search.h"

namespace gauntlet {

struct StateGrowth {
  std::uint64_t runs = 0;
  std::uint64_t states = 0;
  std::uint64_t bytes = 0;  // of all states

  double bytes_per_run() const { return static_cast<double>(bytes) / static_cast<double>(runs); }
};

// Runs the search to its end with a toy fitness and saves its state at every boundary, as a campaign does.
inline StateGrowth GrowthOf(SearchAlgorithm& search) {
  StateGrowth growth;
  std::deque<EvaluationRequest> outstanding;
  while (!search.Progress().finished) {
    for (EvaluationRequest& request : search.Ask()) outstanding.push_back(std::move(request));
    if (outstanding.empty()) break;  // it would never finish: the caller sees too few runs
    const EvaluationRequest next = std::move(outstanding.front());
    outstanding.pop_front();
    search.Tell(OutcomeOf(next, Noise(next)));
    growth.runs += next.replicates;
    if (!search.AtBoundary()) continue;
    search.TakeNewborns();
    ++growth.states;
    growth.bytes += StateOf(search).size();
  }
  return growth;
}

}  // namespace gauntlet
