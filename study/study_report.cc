#include "study/study_report.h"

#include <algorithm>
#include <filesystem>

namespace gauntlet {
namespace {

std::string CommandOf(const Study& study) {
  const TuningChanges& changes = study.changes;
  if (changes == TuningChanges{}) return "study " + study.name;
  std::string command = "tune";
  for (const StudyAnalysis& one : study.analyses) {
    if (!one.tuning) continue;
    command += " " + std::filesystem::path(one.tuning->experiment).filename().string();
    break;
  }
  if (!changes.repeats.empty()) command += " --repeats " + changes.repeats;
  for (const std::string& set : changes.sets) command += " --set " + set;
  for (const std::string& candidates : changes.tries) command += " --try " + candidates;
  if (!changes.budget.empty()) command += " --budget " + changes.budget;
  return command;
}

}  // namespace

Result<StudyReport> MakeStudyReport(const Study& study, const std::string& dir) {
  TRY(auto runs, StudyRuns::Open(study, dir));
  StudyReport report;
  report.name = study.name;
  report.description = study.description;
  report.command = CommandOf(study);
  report.version = GAUNTLET_VERSION;
  for (const StudyPart& part : study.parts) {
    TRY(auto cost, runs.CostOf(part.name));
    TRY(const auto seconds, runs.CpuSecondsOf(part.name));
    cost.cpu_seconds = seconds;
    if (!part.group.empty()) cost.part = part.group;
    const auto group = std::ranges::find(report.parts, cost.part, &PartCost::part);
    if (group == report.parts.end()) {
      report.parts.push_back(cost);
    } else {
      *group += cost;
    }
  }
  for (const auto& [stage, time] : {std::pair(StudyStage::kSearches, &report.searching),
                                    std::pair(StudyStage::kEvaluations, &report.evaluating)}) {
    TRY(const auto measured, runs.TimeOf(stage));
    *time = measured;
  }
  for (const StudyAnalysis& analysis : study.analyses) {
    Result<StudySection> section = Analyse(analysis, runs, report.figures);
    if (!section) {
      return Error{section.error().kind, analysis.where + ": " + section.error().message};
    }
    report.sections.push_back(*std::move(section));
  }
  for (const PublishedRow& row : study.published) {
    TRY(auto judged, Judge(row, report.figures));
    const auto section =
        std::ranges::find(report.sections, row.figure.substr(0, row.figure.find('.')), &StudySection::name);
    (section == report.sections.end() ? report.elsewhere : section->published).push_back(std::move(judged));
  }
  return report;
}

}  // namespace gauntlet
