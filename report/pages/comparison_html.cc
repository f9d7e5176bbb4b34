#include <fmt/format.h>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"

namespace gauntlet {
namespace {

std::string PairsTable(const SetComparison& comparison) {
  Table table({"first", "second", ">A", "95 % interval", "effect", ">p", "by", ">p, Holm"});
  for (const ComparedPair& pair : comparison.pairs) {
    const analysis::Comparison& c = pair.held.comparison;
    const bool alone = !pair.held.paired && !c.relatives;
    table.AddRow({comparison.sets[pair.first].values.name, comparison.sets[pair.second].values.name,
                  FitnessCell(c.test.a), alone ? IntervalCell(c.interval) : Cell(), c.effect,
                  pair.held.p ? DigitsCell(*pair.held.p, 2) : Cell(), pair.held.p_by,
                  pair.p_adjusted ? DigitsCell(*pair.p_adjusted, 2) : Cell()});
  }
  return table.ToHtml();
}

std::string SetsTable(const SetComparison& comparison) {
  Table table({"set", ">runs", ">units", ">mean", ">median"});
  for (const RunSet& set : comparison.sets) {
    std::vector<double> values;
    for (const auto& cluster : set.values.clusters)
      values.insert(values.end(), cluster.begin(), cluster.end());
    const analysis::Description d = analysis::Describe(values);
    table.AddRow({set.values.name, CountCell(d.n),
                  fmt::format("{} ({})", set.values.clusters.size(), set.unit), FitnessCell(d.mean),
                  FitnessCell(d.median)});
  }
  return table.ToHtml();
}

std::string BoxesHtml(const SetComparison& comparison) {
  std::string others;
  for (auto set = comparison.sets.begin() + 1; set != comparison.sets.end(); ++set)
    others += " --with " + PastedPath(set->values.name);
  return FigureHtml(FigureOf(comparison), comparison.sets.front().values.name, others);
}

}  // namespace

std::string ComparisonHtml(const std::vector<SetComparison>& comparisons,
                           const std::vector<std::string>& notes) {
  std::string html;
  if (!notes.empty()) {
    html += "<ul class=\"notes\">\n";
    for (const std::string& note : notes) html += fmt::format("<li>{}</li>\n", Html(note));
    html += "</ul>\n";
  }
  for (const SetComparison& one : comparisons) {
    html += fmt::format(
        "<h2>{}</h2>\n{}{}\n"
        "<p>A is the probability that a run of the first set scores higher than one of the second (Vargha "
        "and Delaney; 0.5 = no difference, 0.56 small, 0.64 medium, 0.71 large). p is "
        "two-sided; where runs are relatives it is of whole units, where both sets are of the same cases of "
        "the "
        "pairs; the last column makes up for the number of tests.</p>\n{}",
        Html(TitleOf(one)), BoxesHtml(one), SetsTable(one), PairsTable(one));
    for (const ComparedPair& pair : one.pairs) {
      html += fmt::format("<p>{}</p>\n", Html(pair.held.words));
      for (const std::string& difference : pair.differences)
        html += fmt::format("<p class=\"soft\">Not like for like: {}</p>\n", Html(difference));
    }
  }
  return html;
}

}  // namespace gauntlet
