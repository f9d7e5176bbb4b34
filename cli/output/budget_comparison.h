// What searches give for the same number of runs, side by side: the table of `gauntlet compare --budget`.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/questions/search_yield.h"

namespace gauntlet {

// Of sets that CheckSameBudget has passed. Medians and means over the searches of each set; the first set is
// tested against each other one.
std::string BudgetText(const std::vector<YieldSet>& sets);
nlohmann::ordered_json BudgetJson(const std::vector<YieldSet>& sets);

}  // namespace gauntlet
