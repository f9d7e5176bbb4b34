// What a study has found beside its sections, as tables and sentences: terminal, Markdown and pages show the
// same.
#pragma once

#include <string>
#include <vector>

#include "study/study_report.h"

namespace gauntlet {

// What the study set out to show, whether that holds, and the figures; without rows when it claims nothing.
StudyTable ClaimTable(const StudyReport& report);
// What its parts have cost.
StudyTable PartTable(const StudyReport& report);
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

// Published figures beside ours.
StudyTable PublishedTable(const std::vector<JudgedRow>& rows, PublishedNotes& notes);

}  // namespace gauntlet
