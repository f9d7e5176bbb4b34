#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/rank_test.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "study/study_report.h"

namespace gauntlet {
namespace {

constexpr double kMostSdRatio = 1.5;  // where standard deviations differ at a glance

// Of a published p-value: "<0.00001" stands for at most that.
std::optional<double> NumberOf(std::string text) {
  if (text.starts_with('<')) text.erase(0, 1);
  return ParseNumber<double>(text);
}

std::optional<double> NumberOf(const StudyFigures& figures, const std::string& name) {
  const auto found = figures.find(name);
  return found == figures.end() ? std::nullopt : found->second.number;
}

// Two-sided p of Welch's t-test.
double WelchP(double mean1, double sd1, double n1, double mean2, double sd2, double n2) {
  const double variance1 = sd1 * sd1 / n1;
  const double variance2 = sd2 * sd2 / n2;
  const double variance = variance1 + variance2;
  if (variance == 0.0) return mean1 == mean2 ? 1.0 : 0.0;
  const double t = std::abs(mean1 - mean2) / std::sqrt(variance);
  const double freedom =
      variance * variance / (variance1 * variance1 / (n1 - 1.0) + variance2 * variance2 / (n2 - 1.0));
  return 2.0 * analysis::StudentUpperTail(t, freedom);
}

double SharesP(double hits1, double trials1, double hits2, double trials2) {
  const auto whole = [](double value) { return static_cast<std::uint32_t>(std::llround(value)); };
  return analysis::FisherExact(whole(hits1), whole(trials1), whole(hits2), whole(trials2)).p_two_sided;
}

// What a rule is told.
struct Compared {
  std::vector<double> arguments;  // of the rule
  std::optional<double> published;
  std::optional<double> ours;
  std::string name;  // of our figure
  const StudyFigures& figures;

  std::optional<double> Sibling(const std::string& figure) const {
    return NumberOf(figures, name.substr(0, name.rfind('.') + 1) + figure);
  }
  std::optional<double> OfAnalysis(const std::string& figure) const {
    return NumberOf(figures, name.substr(0, name.find('.') + 1) + figure);
  }
};

std::optional<bool> MeanAgrees(const Compared& c) {
  const auto sd = c.Sibling("sd");
  const auto n = c.Sibling("n");
  if (!c.published || !c.ours || !sd || !n || c.arguments.size() != 2) return std::nullopt;
  return WelchP(*c.published, c.arguments[0], c.arguments[1], *c.ours, *sd, *n) >= kThesisLevel;
}

std::optional<bool> SpreadAgrees(const Compared& c) {
  if (!c.published || !c.ours) return std::nullopt;
  return *c.ours <= kMostSdRatio * *c.published && *c.published <= kMostSdRatio * *c.ours;
}

std::optional<bool> EffectAgrees(const Compared& c) {
  const auto ours = c.OfAnalysis("a");
  if (!ours || c.arguments.size() != 1) return std::nullopt;
  const double published = c.arguments[0];
  const bool same_side = (published < 0.5) == (*ours < 0.5);
  const auto effect = analysis::EffectOf(published);
  return effect == analysis::EffectOf(*ours) && (same_side || effect == "none");
}

std::optional<bool> SignificanceAgrees(const Compared& c) {
  if (!c.published || !c.ours) return std::nullopt;
  return (*c.published < kThesisLevel) == (*c.ours < kThesisLevel);
}

std::optional<bool> CountAgrees(const Compared& c) {
  const auto of = c.Sibling("of");
  if (!c.published || !c.ours || !of || c.arguments.size() != 1) return std::nullopt;
  return SharesP(*c.published, c.arguments[0], *c.ours, *of) >= kThesisLevel;
}

std::optional<bool> PercentAgrees(const Compared& c) {
  const auto of = c.Sibling("of");
  if (!c.published || !c.ours || !of || c.arguments.size() != 1) return std::nullopt;
  return SharesP(*c.published * c.arguments[0] / 100.0, c.arguments[0], *c.ours * *of / 100.0, *of) >=
         kThesisLevel;
}

std::optional<bool> LiesBetween(const Compared& c) {
  if (c.arguments.size() != 2) return std::nullopt;
  return c.ours && *c.ours >= c.arguments[0] && *c.ours <= c.arguments[1];
}

struct Rule {
  std::string_view name;
  std::optional<bool> (*agrees)(const Compared&);  // nothing: a figure or an argument is missing
  const char* words;
};

constexpr Rule kRules[] = {
    {"mean", MeanAgrees,
     "A mean differs when Welch's t-test, from means, standard deviations and numbers, gives p < 0.01."},
    {"sd", SpreadAgrees, "A standard deviation differs when one is more than 1.5 times the other."},
    {"effect", EffectAgrees,
     "Rank sums, mean ranks, U and A say the same thing; they agree when A is of the same size (none, small, "
     "medium, large by Vargha and Delaney) and on the same side."},
    {"p", SignificanceAgrees, "p-values agree when both are below 0.01, or both are not."},
    {"count", CountAgrees, "A count out of n differs when Fisher's exact test gives p < 0.01."},
    {"percent", PercentAgrees, "So does a share."},
    {"between", LiesBetween,
     "What is published as \"about\" agrees when ours lies in a stated interval around it."},
};

}  // namespace

std::vector<std::string> RulesInWords() {
  std::vector<std::string> words;
  for (const Rule& rule : kRules) words.emplace_back(rule.words);
  words.emplace_back("Words and budgets agree when they are the same.");
  return words;
}

Result<JudgedRow> Judge(const PublishedRow& row, const StudyFigures& figures) {
  if (row.figure.empty()) return JudgedRow{row, "", row.note.text, "not computed"};
  const auto figure = figures.find(row.figure);
  if (figure == figures.end()) {
    return InvalidInput(fmt::format("published row '{}, {}, {}': no analysis gives the figure '{}'",
                                    row.section, row.quantity, row.condition, row.figure));
  }
  JudgedRow judged{row, figure->second.text, row.note.text, "not judged"};
  if (row.rule.empty()) return judged;
  std::vector<std::string> words = Split(row.rule, ' ');
  std::optional<bool> agrees;
  if (words[0] == "same") {
    agrees = figure->second.text == row.value;
  } else {
    const Rule* rule = nullptr;
    for (const Rule& one : kRules) {
      if (one.name == words[0]) rule = &one;
    }
    if (rule == nullptr) {
      return InvalidInput(
          fmt::format("published row '{}, {}': there is no rule '{}'", row.section, row.quantity, words[0]));
    }
    Compared compared{{}, NumberOf(row.value), figure->second.number, row.figure, figures};
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (const auto argument = ParseNumber<double>(words[i])) compared.arguments.push_back(*argument);
    }
    agrees = rule->agrees(compared);
  }
  if (!agrees) {
    return InvalidInput(fmt::format("published row '{}, {}, {}': the rule '{}' does not fit the figure '{}'",
                                    row.section, row.quantity, row.condition, row.rule, row.figure));
  }
  judged.verdict = *agrees ? "agrees" : "differs";
  if (*agrees && !row.note.always) judged.note.clear();
  return judged;
}

}  // namespace gauntlet
