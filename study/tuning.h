// Tuning: the parameters of a search, changed one at a time (thesis 3.2.4). A table [tune.NAME] of a study
// file stands for a baseline and one part for every candidate, each of them evolutions whose final
// populations are simulated again.
#pragma once

#include <vector>

#include "search/experiment/schema.h"
#include "study/study.h"

namespace gauntlet {

struct ExpandedTuning {
  Tuning tuning;
  std::vector<StudyFileTable> parts;  // as if they stood in the file
};

// Error: names what is wrong in the table or in `changes`, and what would be right.
Result<ExpandedTuning> ExpandTuning(const StudyFileTable& table, const TuningChanges& changes,
                                    const Catalogue& catalogue);

}  // namespace gauntlet
