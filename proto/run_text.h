// Runs as people name and type them: "15", and "2:15" of a campaign's second search.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/messages.h"

namespace gauntlet::proto {

// The bits of a run's id that number it within its search; those above number the search, from 0.
inline constexpr int kSequenceBits = 40;

// "15" of the first search, "2:15" of the second.
std::string RunText(RunId run);
// With the search for every run, "1:15": for programs.
std::string RunAddress(RunId run);
// Begins the names of files about it: "run-15", "run-2-15".
std::string RunFileName(RunId run);
// "3 to 40, 2:7"; of more than ten ranges the first ones "and 2 more runs".
std::string RunRanges(std::vector<RunId> runs);
// Reads both, and the id itself. Nothing when it is none of them.
std::optional<RunId> ParseRun(std::string_view text);

}  // namespace gauntlet::proto
