// What a report's pages show of a study: a tuning is one too.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "study/study_report.h"

namespace gauntlet {

struct StudyPages {
  std::string directory;  // as it was given
  std::string name;
  std::string description;
  std::optional<StudyReport> report;  // of a study that has finished
};

// Errors: those of OpenStudy, LookAtStage and MakeStudyReport.
Result<StudyPages> GatherStudy(const std::string& dir);

// The parts of the pages. Everything is HTML; "" where there is nothing to tell.

// What it is and what it has found, with what it has cost.
std::string StudyOverviewHtml(const StudyPages& study);
// What its analyses have found, with published figures beside ours; tunings are not among them.
std::string StudyResultsHtml(const StudyPages& study);
// What its tunings have found: which values to take, and how many repeats are enough.
std::string ParametersHtml(const StudyPages& study);

}  // namespace gauntlet
