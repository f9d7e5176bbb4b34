// The grid over how failed runs of an experiment behaved, in whose cells a search collects failures:
// search.cells, or what the scenario declares (controllers::ScenarioInfo::failures).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"

namespace gauntlet {

inline constexpr int kMostCells = 10000;

// "METRIC:FROM:TO:PARTS", with spaces between several: "split_x:-3:3:5 birds_left:0:10:4". Error: something
// else, a metric that the scenario does not report or that stands twice, an empty range, more than kMostCells
// cells in all.
Result<std::vector<controllers::DescriptorAxis>> ParseCells(const std::string& text,
                                                            const controllers::ScenarioInfo& scenario);
// Of a valid experiment. None: its scenario declares none.
std::vector<controllers::DescriptorAxis> CellsOf(const Experiment& experiment);
// The rule of searches that collect failures in cells.
std::optional<BrokenRule> CheckCells(const Experiment& experiment);

}  // namespace gauntlet
