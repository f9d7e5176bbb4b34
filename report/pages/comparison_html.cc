#include <fmt/format.h>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"

namespace gauntlet {
namespace {

std::string PairsTable(const SetComparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const ComparedPair& pair : comparison.pairs) {
    const analysis::Comparison& c = pair.comparison;
    const auto& interval = c.cluster_interval ? c.cluster_interval : c.interval;
    rows.push_back({Html(comparison.sets[pair.first].values.name),
                    Html(comparison.sets[pair.second].values.name), fmt::format("{:.3f}", c.test.a),
                    interval ? fmt::format("{:.3f} to {:.3f}", interval->low, interval->high) : "-",
                    Html(c.effect), fmt::format("{:.2g}", c.p_two_sided),
                    fmt::format("{:.2g}", pair.p_adjusted)});
  }
  return TableHtml({"first", "second", ">A", "95 % interval", "effect", ">p", ">p, Holm"}, rows);
}

std::string SetsTable(const SetComparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const RunSet& set : comparison.sets) {
    std::vector<double> values;
    for (const auto& cluster : set.values.clusters)
      values.insert(values.end(), cluster.begin(), cluster.end());
    const analysis::Description d = analysis::Describe(values);
    rows.push_back({Html(set.values.name), FormatCount(d.n),
                    fmt::format("{} ({})", set.values.clusters.size(), Html(set.unit)),
                    fmt::format("{:.3f}", d.mean), fmt::format("{:.3f}", d.median)});
  }
  return TableHtml({"set", ">runs", ">units", ">mean", ">median"}, rows);
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
        "and Delaney; 0.5 = no difference, 0.56 small, 0.64 medium, 0.71 large). p is Mann-Whitney's, "
        "two-sided, exact where that can be computed; the last column makes up for the number of "
        "tests.</p>\n{}",
        Html(one.scenario), BoxesHtml(one), SetsTable(one), PairsTable(one));
    for (const ComparedPair& pair : one.pairs) {
      html += fmt::format("<p>{}</p>\n", Html(pair.words));
      for (const std::string& difference : pair.differences)
        html += fmt::format("<p class=\"soft\">Not like for like: {}</p>\n", Html(difference));
    }
  }
  return html;
}

}  // namespace gauntlet
