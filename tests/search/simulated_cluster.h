// A search on a cluster in virtual time: how long its workers have nothing to do.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "search/search_algorithm.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

// How long an evaluation takes, in any unit; a function of the evaluation.
using DurationOf = std::function<double(const EvaluationRequest&)>;

// Pareto with shape 1.5: most evaluations take 1 to 2, some a hundred. The mean is 3, the variance infinite.
inline double HeavyTailed(const EvaluationRequest& request) {
  sim::RandomStream random(3, sim::StreamPurpose::kTest, static_cast<std::uint32_t>(request.individual),
                           request.evaluation);
  const double u = 1.0 - random.Uniform();
  return 1.0 / std::cbrt(u * u);
}

struct Usage {
  double makespan = 0.0;
  double idle_share = 0.0;  // of workers x makespan
};

// Runs the search to its end on `workers` workers; requests are taken in their order, results are told in
// their order.
inline Usage RunOnCluster(SearchAlgorithm& search, int workers, const DurationOf& duration,
                          const std::function<double(const EvaluationRequest&)>& fitness) {
  struct Running {
    EvaluationRequest request;
    bool done = false;
  };
  std::deque<EvaluationRequest> waiting;
  std::map<std::uint64_t, Running> outstanding;       // by logical number
  std::set<std::pair<double, std::uint64_t>> by_end;  // (end, logical number)
  std::deque<std::uint64_t> numbers;                  // of `waiting`
  std::uint64_t asked = 0;
  double now = 0.0;
  double busy = 0.0;
  while (!search.Progress().finished) {
    for (EvaluationRequest& request : search.Ask()) {
      numbers.push_back(++asked);
      waiting.push_back(std::move(request));
    }
    while (!waiting.empty() && std::ssize(by_end) < workers) {
      const double takes = duration(waiting.front());
      busy += takes;
      by_end.emplace(now + takes, numbers.front());
      outstanding[numbers.front()] = {std::move(waiting.front()), false};
      waiting.pop_front();
      numbers.pop_front();
    }
    const auto [end, number] = *by_end.begin();
    by_end.erase(by_end.begin());
    now = end;
    outstanding.at(number).done = true;
    while (!outstanding.empty() && outstanding.begin()->second.done) {
      const EvaluationRequest& told = outstanding.begin()->second.request;
      search.Tell({.individual = told.individual,
                   .evaluation = told.evaluation,
                   .completed = true,
                   .fitness = fitness(told),
                   .runs = {}});
      outstanding.erase(outstanding.begin());
    }
  }
  return {now, 1.0 - busy / (now * workers)};
}

}  // namespace gauntlet
