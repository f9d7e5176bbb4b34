// What a campaign will cost, told before it exists.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/dispatch/pool/worker_program.h"

namespace gauntlet {

struct Forecast {
  std::uint64_t runs = 0;   // of all searches
  std::uint64_t cases = 0;  // different ones, at most
  // Whether there will be exactly that many: children may equal their parents, and searches with the same
  // seed share cases.
  bool cases_exact = false;
  std::uint64_t measured_runs = 0;
  std::uint64_t measured_without_result = 0;  // of those
  std::string why_without_result;             // the latest of them; "" when there is none
  double seconds_per_run = 0.0;               // CPU time on this machine, mean of the measured runs
  double bytes = 0.0;                         // of the campaign's directory at its end

  // With so many workers, each on a core of its own.
  double Seconds(int workers) const { return static_cast<double>(runs) * seconds_per_run / workers; }
};

// Simulates a few of the first runs, at most twelve and for a few seconds, spread over the searches. Later
// generations' may take longer or shorter. Makes no file. Errors: those of MakeSearch and of `simulate`.
Result<Forecast> MakeForecast(
    const std::vector<SearchPlan>& plans,
    const std::function<Result<sim::RunResult>(const sim::RunSpec&)>& simulate =
        [](const sim::RunSpec& spec) { return SimulateInRunner(spec); });

}  // namespace gauntlet
