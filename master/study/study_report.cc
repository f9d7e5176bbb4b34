#include "master/study/study_report.h"

#include <algorithm>

namespace gauntlet::master {

Result<StudyReport> MakeStudyReport(const Study& study, const std::string& dir) {
  Result<StudyRuns> runs = StudyRuns::Open(study, dir);
  if (!runs) return runs.error();
  StudyReport report;
  report.name = study.name;
  report.description = study.description;
  report.version = GAUNTLET_VERSION;
  for (const StudyPart& part : study.parts) {
    const Result<PartCost> cost = runs->CostOf(part.name);
    if (!cost) return cost.error();
    report.parts.push_back(*cost);
  }
  for (const auto& [stage, seconds] : {std::pair(StudyStage::kSearches, &report.search_seconds),
                                       std::pair(StudyStage::kEvaluations, &report.evaluation_seconds)}) {
    const Result<double> measured = runs->SecondsOf(stage);
    if (!measured) return measured.error();
    *seconds = *measured;
  }
  for (const StudyAnalysis& analysis : study.analyses) {
    Result<StudySection> section = Analyse(analysis, *runs, report.figures);
    if (!section) {
      return Error{section.error().kind, analysis.where + ": " + section.error().message};
    }
    report.sections.push_back(*std::move(section));
  }
  for (const PublishedRow& row : study.published) {
    Result<JudgedRow> judged = Judge(row, report.figures);
    if (!judged) return judged.error();
    const auto section =
        std::ranges::find(report.sections, row.figure.substr(0, row.figure.find('.')), &StudySection::name);
    (section == report.sections.end() ? report.elsewhere : section->published).push_back(*std::move(judged));
  }
  return report;
}

}  // namespace gauntlet::master
