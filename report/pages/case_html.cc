#include <algorithm>

#include <fmt/format.h>

#include "analysis/figures/run/run_thumbnail.h"
#include "analysis/tables/section.h"
#include "base/shell_quoted.h"
#include "master/campaign/verdict_text.h"
#include "proto/run_text.h"
#include "report/figures/campaign_figures.h"
#include "report/pages/answers_html.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr double kPicturePixels = 420.0;

const CaseFacts* CaseOf(const CampaignFacts& facts, const StoredRun& run) {
  const auto found = std::ranges::find_if(facts.cases, [&](const CaseFacts& one) {
    return one.search == run.search && one.individual == run.individual;
  });
  return found == facts.cases.end() ? nullptr : &*found;
}

std::string ConfirmationText(const std::optional<Confirmation>& confirmation) {
  if (!confirmation) return "";
  return fmt::format("fails in {} of {} runs with fresh seeds, probability {:.2f} to {:.2f} (95 %): {}",
                     confirmation->tally.failures, confirmation->tally.runs(), confirmation->interval.low,
                     confirmation->interval.high, NameOf(confirmation->verdict));
}

std::string RunFactsHtml(const CampaignFacts& facts, const ShownRun& shown) {
  const StoredRun& run = shown.report.stored;
  const sim::RunResult& result = shown.report.replayed;
  Table table({"", ""});
  table.AddRow({"outcome", analysis::DescribeOutcome(shown.figure)});
  table.AddRow({"failure type", result.failure.label});
  table.AddRow({"fitness", result.verdict == sim::Verdict::kCompleted ? FormatFitness(result.fitness)
                                                                      : NameOf(result.verdict)});
  if (const CaseFacts* of_case = CaseOf(facts, run)) {
    table.AddRow(
        {"test case", fmt::format("{}{} {}", of_case->individual,
                                  facts.plans.size() == 1 ? "" : fmt::format(" of search {}", run.search),
                                  of_case->name)});
    table.AddRow(
        {"its runs", fmt::format("{}, of them {} total failures", of_case->runs, of_case->total_failures)});
    table.AddRow({"confirmed", ConfirmationText(of_case->confirmation)});
    if (RowOf(facts.plans[run.search - 1].experiment).Breeds())
      table.AddRow({"born in generation", of_case->born});
    table.AddRow({"obstacles", of_case->obstacles});
  }
  table.AddRow({"seed", run.seed});
  table.AddRow({"result hash", fmt::format("{:016x}", run.hash)});
  for (const auto& [name, value] : shown.figure.metrics) table.AddRow({name, value});
  return table.ToHtml();
}

std::string CommandsHtml(const CampaignFacts& facts, RunId run) {
  const std::string id = proto::RunText(run);
  const std::string file = proto::RunFileName(run);
  const std::string dir = PastedPath(facts.directory);
  return ToHtml(
      {.title = "Commands",
       .commands = {
           {fmt::format("gauntlet replay {} {} --svg {}.svg", dir, id, file), "See it again, bit for bit"},
           {fmt::format("gauntlet confirm {} {}", dir, id), "How often does it fail with fresh seeds?"},
           {fmt::format("gauntlet minimise {} {}", dir, id), "Which of its obstacles does it take?"},
           {fmt::format("gauntlet blame {} {}", dir, id), "How much does each of them do?"},
           {fmt::format("gauntlet export {} --format csv --what trajectories --run {} --out {}.csv", dir, id,
                        file),
            "Its trajectories as a table"}}});
}

}  // namespace

std::string CaseHtml(const CampaignFacts& facts, std::size_t number, const ShownRun& shown) {
  const RunId id = shown.report.stored.id;
  const std::string page_id = IdOfRun(number, id);
  std::string html = fmt::format(
      "<section class=\"page case\" id=\"{}\">\n<h2>Run {}</h2>\n<p class=\"soft\">{} &middot; <a "
      "href=\"#failures\">all that is shown</a></p>\n",
      page_id, proto::RunText(id), Html(facts.directory));
  if (!shown.trouble.empty())
    html += fmt::format("<ul class=\"notes\"><li>{}</li></ul>\n", Html(shown.trouble));
  if (shown.figure.result.trajectory.empty()) return html + CommandsHtml(facts, id) + "</section>\n";
  html += fmt::format(
      "<p class=\"verdict\">{}</p>\n<div class=\"columns\"><div>\n<div class=\"replay needs-js\" "
      "data-run=\"{}\"></div>\n<noscript><figure><img class=\"arena\" alt=\"The arena from above\" "
      "src=\"{}\"></figure></noscript>\n<p class=\"soft\">The arena from above, as the run went: blue are "
      "those that did well, red those that were lost in the end, green is a guide. The stroke within is "
      "where "
      "a robot heads. A dashed circle appears where the swarm split or an item changed hands, a red ring "
      "around who is trapped.</p>\n</div>\n"
      "<div>{}</div></div>\n",
      Html(analysis::DescribeOutcome(shown.figure)), page_id,
      DataUri(analysis::DrawThumbnail(shown.figure, kPicturePixels)), RunFactsHtml(facts, shown));
  for (const NamedFigure& figure : FiguresOf(shown)) {
    if (figure.name.starts_with("run-")) continue;  // the replay shows more
    html += FigureHtml(figure, facts.directory);
  }
  if (const CaseFacts* of_case = CaseOf(facts, shown.report.stored)) html += AnswersHtml(facts, *of_case);
  return html + CommandsHtml(facts, id) + "</section>\n";
}

std::string CasesHtml(const CampaignPages& pages, std::size_t number) {
  std::string html;
  for (const ShownRun& shown : pages.shown) html += CaseHtml(pages.facts, number, shown);
  return html;
}

}  // namespace gauntlet
