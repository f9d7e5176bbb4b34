// Sets of runs held against each other, as many as a report is given.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "report/figures/campaign_figures.h"
#include "study/sets/set_pair.h"

namespace gauntlet {

struct ComparedPair {
  std::size_t first = 0;  // of SetComparison::sets
  std::size_t second = 0;
  SetPair held;
  std::optional<double> p_adjusted;      // by Holm over all pairs that have a p
  std::vector<std::string> differences;  // why they are not like for like; empty = they are
};

// Sets of one scenario.
struct SetComparison {
  std::string scenario;
  std::vector<RunSet> sets;         // at least two
  std::vector<ComparedPair> pairs;  // each two of up to four sets; of more, each with the first
};

struct SetComparisons {
  std::vector<SetComparison> comparisons;
  std::vector<std::string> notes;  // why something is not compared, or what a reader has to know
};

// An SVG document: a box for each set. `outcome`: a line below the title.
std::string DrawSets(const std::string& title, const std::string& outcome, const std::string& metric,
                     const std::vector<analysis::ComparedSet>& sets);
// How such a picture is read.
inline constexpr std::string_view kReadingOfBoxes =
    "A box for each set of runs holds the middle half of its values, the line in it is the median, the ring "
    "the mean; lower fitness means tougher test cases.";
// Its data: a row for each value. Values of one unit (an evolution, a case) are relatives.
std::string SetsCsv(const std::string& metric, const std::vector<analysis::ComparedSet>& sets);

// What is compared: "campaigns/a against campaigns/b".
std::string TitleOf(const SetComparison& comparison);
// "comparison": a box for each of its sets.
NamedFigure FigureOf(const SetComparison& comparison);

// By their fitness; `names` as `compare` takes them. Sets of scenarios that no other set has, and sets
// without a value, are not compared, which is noted. Errors: those of ReadRunSet.
Result<SetComparisons> CompareSets(const std::vector<std::string>& names);

}  // namespace gauntlet
