// What a search looks for: search.objective.
#pragma once

#include <array>
#include <string_view>

#include "search/experiment/experiment.h"

namespace gauntlet {

// What the fitness of a test case is, as the mean over its runs: the scenario's fitness (thesis); 1 where the
// swarm came through, else the length of all obstacles as a share of the greatest that the experiment allows;
// 1 where the swarm came through, else 0; how far it was from failing by what the experiment requires, -1
// to 1.
enum class Objective { kFitness, kSmallestFailure, kFailureProbability, kRobustness };
// As in experiments, in the order of their numbers.
inline constexpr std::array<std::string_view, 4> kObjectiveNames = {"fitness", "smallest-failure",
                                                                    "failure-probability", "robustness"};
// Where SearchSpec::parameters holds its number; missing = kFitness.
inline constexpr std::string_view kObjectiveParameter = "objective";

inline Objective ObjectiveOf(const SearchSpec& search) {
  const auto found = search.parameters.find(std::string(kObjectiveParameter));
  return found == search.parameters.end() ? Objective::kFitness : static_cast<Objective>(found->second);
}

}  // namespace gauntlet
