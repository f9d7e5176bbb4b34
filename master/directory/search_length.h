// How long the searches of a campaign go on: all that may change of them once they have begun.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

// The searches with the lengths that `sets` ("key=value") give them. Each search takes those of its own key
// (SearchInfo::length); those of a sweep that go by another key stay as they are. Error: kInvalidInput, which
// begins with "--set key=value:": no search goes by this key, the sweep tells its searches apart by it, or
// the value is out of range or below the present one.
Result<std::vector<SearchPlan>> WithLength(const std::vector<SearchPlan>& plans,
                                           const std::vector<std::string>& sets);

// Whether both are the same searches of the same length, their cases aside. Keys that a search does not read
// may differ: those that came after a campaign was stored have their defaults.
bool AreSameSearches(const std::vector<SearchPlan>& some, const std::vector<SearchPlan>& others);

// "search.generations from 50 to 80"; "" when nothing differs.
std::string DescribeLengths(const std::vector<SearchPlan>& before, const std::vector<SearchPlan>& after);

}  // namespace gauntlet
