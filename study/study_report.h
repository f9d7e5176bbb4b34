// What a study has found: its own figures, the published ones beside them, and whether they agree. Plain
// structs, so that terminal, Markdown and JSON say the same.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/interval.h"
#include "analysis/statistics/parameter_analysis.h"
#include "analysis/tables/table.h"
#include "base/result.h"
#include "study/study_campaigns.h"

namespace gauntlet {

// The significance level of the thesis' tests (4.6.2).
inline constexpr double kThesisLevel = 0.01;

// By "ANALYSIS.FIGURE", "severity.first.mean": a number, or a word such as "never".
using StudyFigures = std::map<std::string, Cell>;
// Of a count: a number like the others, so that one can be held against another.
inline Cell WholeCell(std::uint64_t count) {
  return {std::to_string(count), static_cast<double>(count)};
}

// What a study set out to show.
struct StudyClaim {
  std::string text;
  bool holds = false;
};

struct JudgedRow {
  PublishedRow row;
  std::string ours;     // "" = not computed
  std::string note;     // "" = none
  std::string verdict;  // "agrees", "differs", "not judged", "not computed"
};

// What came of one value of a parameter.
struct TriedValue {
  std::string value;
  bool is_baseline = false;
  std::size_t evolutions = 0;     // that gave a result
  std::uint64_t simulations = 0;  // of one evolution
  double mean = 0.0;              // of the evolutions' fitness, as TuningResult says
  double median = 0.0;
  double a = 0.5;  // probability that the baseline's fitness exceeds this one's: above 0.5 this is tougher
  std::optional<analysis::Interval> interval;
  std::string effect = "none";
  bool exceeds = false;  // A is large, in either direction
  double p = 1.0;        // two-sided, by itself
  double p_holm = 1.0;   // adjusted for all values of all parameters
};
struct TriedParameter {
  std::string key;
  std::string baseline;
  std::vector<TriedValue> values;
  std::string recommended;
  std::string evidence;
};
// Spartan's robustness and consistency analysis. Every evolution counts once, by the mean fitness of its
// final population, simulated again with fresh seeds.
struct TuningResult {
  std::vector<TriedParameter> parameters;
  std::vector<analysis::Consistency> consistency;  // by size; none of too few evolutions
  std::optional<std::size_t> enough;               // repeats
  std::string enough_in_words;
  std::string p_by;
};

// The sets that an analysis of the kind "compare" holds against each other.
struct ComparedSets {
  std::string metric;
  std::vector<analysis::ComparedSet> sets;
};

struct StudySection {
  std::string name;
  std::string title;
  std::vector<Table> tables;
  std::vector<std::string> sentences;
  std::optional<StudyClaim> claim;
  std::vector<JudgedRow> published;
  std::optional<TuningResult> tuning;    // of the kind "tune"
  std::optional<ComparedSets> compared;  // of the kind "compare"
};

struct StudyReport {
  std::string name;
  std::string description;
  std::string command;  // that makes it, "study thesis"
  std::string version;
  std::vector<PartCost> parts;
  ClockTime searching;  // the campaign of all searches
  ClockTime evaluating;
  std::vector<StudySection> sections;
  std::vector<JudgedRow> elsewhere;  // published rows that we have no figure for
  StudyFigures figures;
};

// Computes everything of a study whose campaigns have finished. Error: they cannot be read, or an analysis
// asks for what the runs do not have.
Result<StudyReport> MakeStudyReport(const Study& study, const std::string& dir);

// One analysis; its figures are added to `figures`.
Result<StudySection> Analyse(const StudyAnalysis& analysis, StudyRuns& runs, StudyFigures& figures);
// The same of the kind "tune".
Result<StudySection> AnalyseTuning(const StudyAnalysis& analysis, StudyRuns& runs, StudyFigures& figures);

// Our figure beside a published one. Rules:
//   mean SD N     Welch's t-test from means, standard deviations and numbers: differs when p < 0.01
//   sd            differs when one is more than 1.5 times the other
//   effect A      of the same size (none, small, medium, large) and on the same side as A = P(first > second)
//   p             both below 0.01, or both not
//   count N       Fisher's exact test of k of N against ours: differs when p < 0.01
//   percent N     the same of a share of N, in percent
//   between L H   ours lies between
//   same          the same text
// Error: no such rule, or a figure that it needs is missing.
Result<JudgedRow> Judge(const PublishedRow& row, const StudyFigures& figures);
// The rules in words, one each.
std::vector<std::string> RulesInWords();

}  // namespace gauntlet
