#include <array>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/rank_test.h"
#include "base/nearest_name.h"
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

std::optional<double> NumberOf(const Cell& figure) {
  const auto* number = std::get_if<double>(&figure.value);
  return number == nullptr ? std::nullopt : std::optional(*number);
}

std::optional<double> NumberOf(const StudyFigures& figures, const std::string& name) {
  const auto found = figures.find(name);
  return found == figures.end() ? std::nullopt : NumberOf(found->second);
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

// What a rule is told.
struct Compared {
  std::vector<double> arguments;  // of the rule
  std::optional<double> published;
  std::optional<double> ours;
  const PublishedRow& row;
  const StudyFigures& figures;

  std::optional<double> Sibling(const std::string& figure) const {
    return NumberOf(figures, row.figure.substr(0, row.figure.rfind('.') + 1) + figure);
  }
  std::optional<double> OfAnalysis(const std::string& figure) const {
    return NumberOf(figures, row.figure.substr(0, row.figure.find('.') + 1) + figure);
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

// Two shares; of one in percent `hundred` is 100.
std::optional<bool> SharesAgree(const Compared& c, double hundred) {
  const auto of = c.Sibling("of");
  if (!c.published || !c.ours || !of || c.arguments.size() != 1) return std::nullopt;
  const auto whole = [](double value) { return static_cast<std::uint32_t>(std::llround(value)); };
  const auto hits = [&](double share, double n) {
    return whole(hundred == 1.0 ? share : share * n / hundred);
  };
  const analysis::FisherTest test = analysis::FisherExact(
      hits(*c.published, c.arguments[0]), whole(c.arguments[0]), hits(*c.ours, *of), whole(*of));
  return test.p_two_sided >= kThesisLevel;
}

std::optional<bool> CountAgrees(const Compared& c) {
  return SharesAgree(c, 1.0);
}

std::optional<bool> PercentAgrees(const Compared& c) {
  return SharesAgree(c, 100.0);
}

std::optional<bool> LiesBetween(const Compared& c) {
  if (c.arguments.size() != 2) return std::nullopt;
  return c.ours && *c.ours >= c.arguments[0] && *c.ours <= c.arguments[1];
}

std::optional<bool> IsTheSame(const Compared& c) {
  return c.figures.at(c.row.figure).text == c.row.value;
}

struct Rule {
  std::string_view name;
  std::optional<bool> (*agrees)(const Compared&);  // nothing: a figure or an argument is missing
  const char* words;
};

constexpr std::array kRules = std::to_array<Rule>({
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
    {"same", IsTheSame, "Words and budgets agree when they are the same."},
});

}  // namespace

std::vector<std::string> RulesInWords() {
  std::vector<std::string> words;
  for (const Rule& rule : kRules) words.emplace_back(rule.words);
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
  const std::vector<std::string> words = Split(row.rule, ' ');
  const Rule* rule = FindByName(kRules, words[0]);
  if (rule == nullptr) {
    return InvalidInput(
        fmt::format("published row '{}, {}': there is no rule '{}'", row.section, row.quantity, words[0]));
  }
  Compared compared{{}, NumberOf(row.value), NumberOf(figure->second), row, figures};
  for (const std::string& word : words) {
    if (const auto argument = ParseNumber<double>(word)) compared.arguments.push_back(*argument);
  }
  const std::optional<bool> agrees = rule->agrees(compared);
  if (!agrees) {
    return InvalidInput(fmt::format("published row '{}, {}, {}': the rule '{}' does not fit the figure '{}'",
                                    row.section, row.quantity, row.condition, row.rule, row.figure));
  }
  judged.verdict = *agrees ? "agrees" : "differs";
  if (*agrees && !row.note.always) judged.note.clear();
  return judged;
}

}  // namespace gauntlet
