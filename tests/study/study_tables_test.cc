#include "study/study_tables.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

JudgedRow Row(const std::string& figure, const std::string& rule, const std::string& verdict) {
  JudgedRow row;
  row.row.figure = figure;
  row.row.rule = rule;
  row.verdict = verdict;
  return row;
}

StudySection Comparing(const std::string& name, const std::string& first, const std::string& second) {
  StudySection section;
  section.name = name;
  section.compared = ComparedSets{"fitness", {{first, {}}, {second, {}}}};
  return section;
}

TEST(TallyInWords, CountsAQuantityThatIsPrintedSeveralTimesOnce) {
  StudyReport report;
  EXPECT_EQ(TallyInWords(report), "");

  StudySection severity = Comparing("severity", "evolved", "random");
  severity.published = {Row("severity.first.mean", "mean 0.2 100", "agrees"),
                        Row("severity.first.sd", "sd", "differs"),
                        Row("severity.second.mean", "mean 0.2 100", "agrees"),
                        Row("severity.first.u", "effect 0.08", "agrees"),
                        Row("severity.a", "effect 0.08", "agrees"),
                        Row("severity.p", "p", "agrees")};
  StudySection pair = Comparing("pair", "evolved", "improved");
  pair.published = {Row("pair.first.mean", "mean 0.2 100", "differs"),  // a misprint: of a set that was met
                    Row("pair.a", "effect 0.3", "differs")};
  report.sections = {severity, pair};
  report.elsewhere = {Row("", "", "not computed")};
  EXPECT_EQ(
      TallyInWords(report),
      "Of 9 published figures 5 agree with ours, 3 differ, 0 stand beside ours without being judged, and 1 "
      "have no counterpart here. Many of them say the same: of 5 means, standard deviations and effect "
      "sizes, each counted once, 3 agree.");
}

}  // namespace
}  // namespace gauntlet
