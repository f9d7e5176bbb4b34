#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/study_report.h"

namespace gauntlet {
namespace {

const StudyFigures kFigures = {
    {"c.first.mean", {"0.500", 0.5}}, {"c.first.sd", {"0.200", 0.2}},    {"c.first.n", {"100", 100.0}},
    {"c.a", {"0.1000", 0.1}},         {"c.p", {"1e-09", 1e-9}},          {"k.first.count", {"50", 50.0}},
    {"k.first.of", {"100", 100.0}},   {"k.first.percent", {"50", 50.0}}, {"w.steady", "never"}};

std::string Verdict(const std::string& value, const std::string& figure, const std::string& rule) {
  const auto judged = Judge({"1.1", "what", "of", value, figure, rule, {"why", false}}, kFigures);
  return judged ? judged->verdict : judged.error().message;
}

TEST(Judge, MeansAreComparedByWelchsTest) {
  EXPECT_EQ(Verdict("0.55", "c.first.mean", "mean 0.2 100"), "agrees");   // t = 1.77
  EXPECT_EQ(Verdict("0.60", "c.first.mean", "mean 0.2 100"), "differs");  // t = 3.54
  EXPECT_EQ(Verdict("0.60", "c.first.mean", "mean 0.2 10"), "agrees");
}

TEST(Judge, EveryOtherRuleHasItsOwnMeasure) {
  EXPECT_EQ(Verdict("0.29", "c.first.sd", "sd"), "agrees");
  EXPECT_EQ(Verdict("0.31", "c.first.sd", "sd"), "differs");
  EXPECT_EQ(Verdict("5828.5", "c.first.mean", "effect 0.0778"), "agrees");
  EXPECT_EQ(Verdict("5828.5", "c.first.mean", "effect 0.35"), "differs") << "medium";
  EXPECT_EQ(Verdict("5828.5", "c.first.mean", "effect 0.95"), "differs") << "the other side";
  EXPECT_EQ(Verdict("<0.00001", "c.p", "p"), "agrees");
  EXPECT_EQ(Verdict("0.3", "c.p", "p"), "differs");
  EXPECT_EQ(Verdict("40", "k.first.count", "count 100"), "agrees");
  EXPECT_EQ(Verdict("24", "k.first.count", "count 100"), "differs");
  EXPECT_EQ(Verdict("24", "k.first.percent", "percent 100"), "differs");
  EXPECT_EQ(Verdict("30", "k.first.count", "between 45 55"), "agrees");
  EXPECT_EQ(Verdict("16-18", "w.steady", "between 16 18"), "differs") << "never is not between";
  EXPECT_EQ(Verdict("never", "w.steady", "same"), "agrees");
  EXPECT_EQ(Verdict("7", "k.first.count", ""), "not judged");
  EXPECT_EQ(Verdict("7", "", ""), "not computed");
}

TEST(Judge, ARuleThatDoesNotFitIsAnError) {
  EXPECT_EQ(Verdict("7", "k.first.counts", "same"),
            "published row '1.1, what, of': no analysis gives the figure 'k.first.counts'");
  EXPECT_EQ(Verdict("7", "k.first.count", "equal"), "published row '1.1, what': there is no rule 'equal'");
  EXPECT_EQ(Verdict("7", "k.first.count", "count"),
            "published row '1.1, what, of': the rule 'count' does not fit the figure 'k.first.count'");
  EXPECT_EQ(Verdict("many", "c.first.sd", "sd"),
            "published row '1.1, what, of': the rule 'sd' does not fit the figure 'c.first.sd'");
}

TEST(Judge, AReasonIsGivenWhereFiguresDifferAndARemarkAlways) {
  PublishedRow row{"1.1", "what", "of", "0.31", "c.first.sd", "sd", {"why", false}};
  EXPECT_EQ(Judge(row, kFigures)->note, "why");
  row.value = "0.21";
  EXPECT_EQ(Judge(row, kFigures)->note, "");
  row.note.always = true;
  EXPECT_EQ(Judge(row, kFigures)->note, "why");
}

}  // namespace
}  // namespace gauntlet
