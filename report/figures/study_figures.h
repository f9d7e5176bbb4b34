// The figures of a study by name: what `gauntlet figure` writes and reports show.
#pragma once

#include <vector>

#include "report/figures/campaign_figures.h"
#include "study/study_report.h"

namespace gauntlet {

// Of a tuning "robustness" and, where that was computed, "consistency" (of several tunings in one study with
// "-NAME" behind it); of a comparison its box plots, under the analysis' name; of other sections none.
// `section` is one of the report's and must outlive them.
std::vector<NamedFigure> FiguresOf(const StudyReport& report, const StudySection& section);

// Of all its sections.
std::vector<NamedFigure> FiguresOf(const StudyReport& report);

}  // namespace gauntlet
