// What a study has found beside its sections, as tables and sentences: terminal, Markdown, JSON and pages
// tell the same.
#pragma once

#include <string>
#include <vector>

#include "study/study_report.h"

namespace gauntlet {

// What the study set out to show, whether that holds, and its figures where they are asked for; without rows
// when it claims nothing.
Table ClaimTable(const StudyReport& report, bool with_figures = false);
// What its parts have cost, and all of them together.
Table PartTable(const StudyReport& report, bool with_all = true);
// What came of the values of a parameter. Programs are told nothing of the baseline against itself.
Table ValueTable(const TriedParameter& parameter);
Table ConsistencyTable(const TuningResult& tuning);
// How long it took by the clock.
std::string TimeInWords(const StudyReport& report);
// How many published figures agree; "" where nothing was published.
std::string TallyInWords(const StudyReport& report);

// The notes of published rows, numbered in the order in which they are met.
class PublishedNotes {
 public:
  // The note's number; "" of none.
  std::string Mark(const std::string& note);
  const std::vector<std::string>& all() const { return notes_; }

 private:
  std::vector<std::string> notes_;
};

// Published figures beside ours, of the analysis of this name; "" = of none.
Table PublishedTable(const std::vector<JudgedRow>& rows, PublishedNotes& notes,
                     const std::string& analysis = "");

}  // namespace gauntlet
