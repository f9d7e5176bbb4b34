#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/figures/run/run_thumbnail.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "proto/run_text.h"
#include "report/figures/archive_figure.h"
#include "report/pages/answers_html.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"
#include "report/tables/conditions.h"

namespace gauntlet {
namespace {

constexpr double kThumbnailPixels = 220.0;
constexpr std::size_t kMostCases = 50;  // of the table of cases, where no script makes a whole one

std::string CellHtml(const CampaignPages& pages, std::size_t number, const analysis::HeatCell& cell,
                     RunId toughest, std::uint64_t largest) {
  if (cell.count == 0) return fmt::format("<td class=\"none\" title=\"{}: none\"></td>", Html(cell.meaning));
  const analysis::HeatColors colors = analysis::HeatColorsOf(cell.count, largest);
  const std::string title = Html(fmt::format("{}: {} runs; the toughest is run {}", cell.meaning,
                                             FormatCount(cell.count), proto::RunText(toughest)));
  std::string html = FormatCount(cell.count);
  if (const std::string link = pages.LinkTo(number, toughest); !link.empty())
    html = fmt::format("<a href=\"{}\" aria-label=\"{}\">{}</a>", link, title, html);
  return fmt::format("<td style=\"background:{};color:{}\" title=\"{}\">{}</td>", colors.fill, colors.text,
                     title, html);
}

std::string MapHtml(const CampaignPages& pages, std::size_t number, const RunMap& map) {
  std::string html = fmt::format(
      "<h3>{}</h3>\n<p>{}. {} A click on a field leads to its toughest run.</p>\n"
      "<div class=\"scroll\"><table class=\"map\"><thead><tr><th></th><th scope=\"colgroup\" "
      "colspan=\"{}\">{}</th></tr>\n<tr><th scope=\"col\">{}</th>",
      Html(map.title), Html(map.outcome), Html(map.reading), map.columns.size(), Html(map.across_name),
      Html(map.down_name));
  for (const std::string& column : map.columns)
    html += fmt::format("<th scope=\"col\">{}</th>", Html(column));
  html += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", Html(map.rows[row]));
    for (std::size_t i = 0; i < map.columns.size(); ++i)
      html += CellHtml(pages, number, map.cells[row][i], map.toughest[row][i], map.Largest());
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n" + ForAPaperHtml(map.name, pages.facts.directory);
}

// A list of the first runs that are shown, each with a link to its page; "" where none can be drawn.
std::string ThumbnailsOf(const CampaignPages& pages, std::size_t number, std::size_t most) {
  std::string html;
  std::size_t drawn = 0;
  for (const ShownRun& one : pages.shown) {
    if (one.figure.result.trajectory.empty()) continue;
    if (drawn++ == most) break;
    const RunId id = one.report.stored.id;
    html += fmt::format(
        "<li><a href=\"#{}\"><img alt=\"\" width=\"220\" height=\"220\" src=\"{}\">Run {}: {}</a></li>\n",
        IdOfRun(number, id), DataUri(analysis::DrawThumbnail(one.figure, kThumbnailPixels)),
        proto::RunText(id), Html(analysis::DescribeOutcome(one.figure)));
  }
  return html.empty() ? "" : fmt::format("<ul class=\"thumbs\">\n{}</ul>\n", html);
}

std::string ThumbnailsHtml(const CampaignPages& pages, std::size_t number) {
  const std::string thumbnails = ThumbnailsOf(pages, number, pages.shown.size());
  if (thumbnails.empty()) return "";
  return fmt::format(
      "<h3>What it looks like</h3>\n<p>The arena of each run from above, with every robot's trajectory. Blue "
      "ones are of robots that did well, red ones of those that were lost, green is a guide; dots are where "
      "they ended. A click leads to the run.</p>\n{}",
      thumbnails);
}

std::string AllCasesHtml(const CampaignPages& pages, std::size_t number) {
  const Table table =
      CaseTable(pages.facts, kMostCases, [&](RunId run) { return pages.LinkTo(number, run); });
  const std::vector<CaseFacts>& cases = pages.facts.cases;
  const auto as_tough = static_cast<std::size_t>(std::ranges::count(
      cases, cases.front().fitness.mean(), [](const CaseFacts& one) { return one.fitness.mean(); }));
  const std::string which = as_tough > table.size()
                                ? fmt::format("{} of the {} toughest", table.size(), FormatCount(as_tough))
                                : fmt::format("The toughest {}", table.size());
  return fmt::format(
      "<h3>Test cases</h3>\n<p>A row for each test case of each search, the toughest first: its number, how "
      "its runs "
      "ended, and its toughest run. Copies of a layout have rows of their own. A run that has a replay here "
      "is a link.</p>\n"
      "<div class=\"all-cases\" data-campaign=\"{}\">\n<p class=\"soft\">{} of {}.</p>{}</div>\n",
      number, which, FormatCount(cases.size()), table.ToHtml());
}

}  // namespace

std::string IdOfRun(std::size_t number, RunId run) {
  return fmt::format("run-{}-{}", number, run);
}

Table CaseTable(const CampaignFacts& facts, std::size_t most, const std::function<std::string(RunId)>& link) {
  const Experiment& experiment = facts.plans.front().experiment;
  const controllers::FailureTypes& types = controllers::DeclaredScenario(experiment).failure_types;
  Table table({{">case", "case"},
               {">search", "search"},
               {"name", "name"},
               {">mean fitness", "mean"},
               {">runs", "runs"},
               {">total failures", "failures"},
               {"failure of the toughest run", "type"},
               {"confirmed", "confirmed"},
               {">toughest run", "run"}});
  for (const CaseFacts& one : facts.cases) {
    if (table.size() == most) break;
    const controllers::FailureType* type = types.Find(one.failure_type);
    const double mean = std::round(one.fitness.mean() * 1e4) / 1e4;  // what is read, in few bytes
    const auto& confirmed = one.confirmation;
    table.AddRow(
        {one.individual, one.search, TextCell(one.name), FitnessCell(mean), CountCell(one.runs),
         CountCell(one.total_failures), TextCell(type == nullptr ? "" : type->name),
         TextCell(confirmed ? OutOfCell(confirmed->tally.failures, confirmed->tally.runs()).text : ""),
         one.toughest == 0
             ? Cell()
             : LinkCell(Cell(proto::RunText(one.toughest), one.toughest), link ? link(one.toughest) : "")});
  }
  return table;
}

std::string ToughestRunsHtml(const CampaignPages& pages, std::size_t number) {
  constexpr std::size_t kMostToughest = 4;
  const bool better = !pages.typical.empty() || !pages.smallest.empty();
  if (better || pages.facts.summary.failing_runs == 0) return "";
  const std::string thumbnails = ThumbnailsOf(pages, number, kMostToughest);
  if (thumbnails.empty()) return "";
  return fmt::format(
      "<h3>What a failure looks like</h3>\n<p>The arena from above; trajectories of robots that did well are "
      "blue, of those that were lost red. <a href=\"#failures\">More runs</a></p>\n{}",
      thumbnails);
}

std::string FailuresHtml(const CampaignPages& pages, std::size_t number) {
  std::string html = CampaignHeading(pages.facts);
  if (pages.facts.cases.empty()) return html + "<p>There is no run yet.</p>\n";
  if (pages.maps.empty() && ConditionsOf(pages.facts.summary).size() == 1)
    html += "<p>Nothing failed, and the scenario describes no behaviour.</p>\n";
  for (const NamedFigure& figure : ArchiveFigures(pages.facts))
    html += FigureHtml(figure, pages.facts.directory);
  html += DistinctFailuresHtml(pages, number) + MinimisedCasesHtml(pages, number);
  for (const RunMap& map : pages.maps) html += MapHtml(pages, number, map);
  return html + ThumbnailsHtml(pages, number) + AllCasesHtml(pages, number);
}

}  // namespace gauntlet
