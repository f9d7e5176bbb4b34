// What `gauntlet examine` asks about a swarm, and how it spends its runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

struct ExaminationPlan {
  static constexpr std::uint64_t kDefaultRuns = 8000;
  static constexpr std::uint64_t kDefaultProgramRuns =
      2000;  // of a program of the user's, which takes longer

  std::uint64_t runs = 0;          // about so many in all
  std::uint64_t random_cases = 0;  // that are simulated once each
  std::uint64_t search_runs = 0;
  // The search: an archive of different failures, or a genetic search where the scenario does not say along
  // which metrics failures differ.
  std::string algorithm = "archive";
  std::string search_length = "";     // "search.runs=3850"
  int replicates = 20;                // of each case that it ends with
  std::size_t minimised = 0;          // cases of different failures that are made smaller
  std::vector<std::string> vary;      // for `margin`: a disturbance of each device, and faulty robots
  std::uint64_t margin_runs = 0;      // of each of these
  std::vector<std::string> unvaried;  // for which there are too few runs
};

// `runs`: 0 = as many as is usual. First what confirming takes, should a case be found for every cell of the
// archive (else for every member of the population), and making one to three cases smaller. Of the rest a
// tenth is for random cases (at most 200), four tenths for margins (at most 600 each), and what is left for
// the search. Error: too few runs, and how many are needed.
Result<ExaminationPlan> PlanExamination(const Experiment& experiment, std::uint64_t runs);

}  // namespace gauntlet
