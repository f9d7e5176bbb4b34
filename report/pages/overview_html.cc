#include <algorithm>
#include <cmath>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "report/figures/archive_figure.h"
#include "report/figures/campaign_figures.h"
#include "report/pages/answers_html.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kCoursesAtOnce = 3;
constexpr std::size_t kMostBlocks = 12;  // of a search's course

std::string Fitness(double value) {
  return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-";
}

std::string TimeText(std::int64_t unix_ms) {
  return unix_ms == 0 ? "" : fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(unix_ms / 1000));
}

// "1, 2, 3 and 17 more"
std::string Listed(const std::vector<std::string>& texts) {
  constexpr std::size_t kMost = 20;
  const std::size_t shown = std::min(kMost, texts.size());
  std::string text =
      fmt::format("{}", fmt::join(texts.begin(), texts.begin() + static_cast<int>(shown), ", "));
  return texts.size() > shown ? fmt::format("{} and {} more", text, texts.size() - shown) : text;
}

// What was tested.
std::string TestedHtml(const CampaignFacts& facts) {
  const Experiment& experiment = facts.plans.front().experiment;
  const auto* scenario = controllers::FindScenario(experiment);
  const auto* controller = controllers::FindController(experiment);
  const SearchRow& search = RowOf(experiment);
  const CampaignSummary& summary = facts.summary;
  std::string failed = FormatCount(summary.total_failures);
  return FactsHtml(
      {{"scenario", fmt::format("{}{}", Html(experiment.scenario),
                                scenario == nullptr ? "" : ": " + Html(scenario->description))},
       {"controller under test",
        fmt::format("{}{}", Html(experiment.controller),
                    controller == nullptr ? "" : ": " + Html(controller->description))},
       {"search",
        facts.plans.size() == 1
            ? Html(fmt::format("{}: {}", search.title, search.plan == nullptr ? "" : search.plan(experiment)))
            : fmt::format("{} searches in one campaign", facts.plans.size())},
       {"budget", fmt::format("{} runs, {} different test cases", FormatCount(summary.runs_done),
                              FormatCount(summary.distinct_individuals))},
       {"fitness at the end",
        fmt::format("best {}, mean {}, worst {} (lower = tougher)", Fitness(summary.best_fitness),
                    Fitness(summary.mean_fitness), Fitness(summary.worst_fitness))},
       {"total failures", failed},
       {"state", summary.finished ? "finished" : "not finished"}});
}

std::string ProvenanceHtml(const CampaignFacts& facts) {
  std::vector<std::string> seeds;
  for (const SearchPlan& plan : facts.plans) seeds.push_back(fmt::format("{}", plan.experiment.seed));
  const CampaignHistory& history = facts.history;
  return FactsHtml(
      {{"made by", Html(fmt::format("gauntlet {}", facts.software_version))},
       {"golden hashes", Html(facts.golden_hashes)},
       {facts.plans.size() == 1 ? "seed" : "seeds", Html(Listed(seeds))},
       {"hosts of workers", Html(Listed(history.hosts))},
       {"created", TimeText(history.created_unix_ms)},
       {"last event", TimeText(history.last_unix_ms)},
       {"time served", fmt::format("{} in {} {}", FormatDuration(history.served_seconds), history.sessions,
                                   history.sessions == 1 ? "session" : "sessions")},
       {"state hash", Html(facts.summary.state_hash)}});
}

// The command that makes the same campaign again; "" where there is no single one.
std::string AgainCommand(const CampaignFacts& facts) {
  const SearchRow& row = RowOf(facts.plans.front().experiment);
  if (facts.plans.size() != 1 || row.given_cases) return "";
  const std::string toml = PastedPath(facts.directory + "/experiment.toml");
  const std::string length =
      row.length_option.empty()
          ? ""
          : fmt::format(" {} {}", row.length_option, facts.summary.progress.evaluations_planned);
  return fmt::format("gauntlet {} {}{} --dir again", row.command, toml, length);
}

std::string CommandsHtml(const CampaignFacts& facts) {
  const std::string dir = PastedPath(facts.directory);
  std::string html = "<h3>Commands</h3>\n";
  if (const std::string again = AgainCommand(facts); !again.empty()) {
    html += "<p>The same campaign once more; it must end with the same state hash:</p>\n" +
            CommandHtml(again) + CommandHtml("gauntlet show again");
  }
  if (!facts.summary.finished)
    html += "<p>Go on where it stopped:</p>\n" + CommandHtml("gauntlet resume " + dir);
  return html + "<p>How often do the failing cases fail with fresh seeds?</p>\n" +
         CommandHtml(fmt::format("gauntlet confirm {} --all-failing", dir)) +
         "<p>Every run as a table:</p>\n" +
         CommandHtml(fmt::format("gauntlet export {} --format csv --out runs.csv", dir));
}

// A search's course in numbers: the first part, the last, and some at even distances between them.
std::string CourseTable(const SearchCourse& course) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t repeat = 0; repeat < course.repeats.size() && repeat < 1; ++repeat) {
    const std::vector<CourseBlock>& blocks = course.repeats[repeat];
    const std::size_t gaps = blocks.size() - 1;
    const std::size_t shown = std::min(gaps, kMostBlocks - 1);
    for (std::size_t i = 0; i <= shown; ++i) {
      const CourseBlock& block = blocks[shown == 0 ? 0 : (i * gaps + shown / 2) / shown];
      rows.push_back({FormatCount(block.runs), Fitness(block.best), Fitness(block.mean),
                      fmt::format("{:.1f} %", 100.0 * block.failure_share)});
    }
  }
  const std::string which =
      course.repeats.size() > 1 ? "The first of these searches in numbers" : "In numbers";
  return fmt::format(
      "<details><summary>{}</summary>{}</details>\n", which,
      TableHtml({">runs spent", ">toughest fitness", ">mean fitness", ">total failures"}, rows));
}

// The first kinds of searches are seen at once, the others on demand.
std::string CoursesHtml(const CampaignPages& pages) {
  const std::vector<NamedFigure> figures = FiguresOf(pages.courses, {});
  std::string html;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    if (i == kCoursesAtOnce)
      html += fmt::format("<details><summary>How {} other kinds of searches went</summary>\n",
                          figures.size() - i);
    html += FigureHtml(figures[i], pages.facts.directory) + CourseTable(pages.courses[i]);
  }
  return figures.size() > kCoursesAtOnce ? html + "</details>\n" : html;
}

std::string SearchesTable(const CampaignSummary& summary) {
  if (summary.searches.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < summary.searches.size(); ++i) {
    const CampaignSummary& one = summary.searches[i];
    rows.push_back({fmt::format("{}", i + 1), Html(one.settings), FormatCount(one.runs_done),
                    Fitness(one.best_fitness), Fitness(one.mean_fitness), FormatCount(one.total_failures),
                    one.finished ? "yes" : "no"});
  }
  return fmt::format(
      "<details><summary>The {} searches</summary>{}</details>\n", summary.searches.size(),
      TableHtml({">search", "settings", ">runs", ">best", ">mean", ">total failures", "finished"}, rows));
}

}  // namespace

std::string OverviewHtml(const CampaignPages& pages, std::size_t number) {
  const CampaignFacts& facts = pages.facts;
  std::string html =
      fmt::format("<h2>{}</h2>\n<p class=\"soft\">{}</p>\n<p class=\"verdict\">{}</p>\n",
                  Html(facts.summary.experiment), Html(facts.directory), Html(VerdictOf(pages)));
  if (!facts.notes.empty()) {
    html += "<ul class=\"notes\">\n";
    for (const std::string& note : facts.notes) html += fmt::format("<li>{}</li>\n", Html(note));
    html += "</ul>\n";
  }
  html += DistinctFailuresHtml(pages, number);
  html += fmt::format(
      "<div class=\"columns\"><div><h3>What was tested</h3>\n{}</div>\n<div><h3>Where it comes "
      "from</h3>\n{}</div></div>\n",
      TestedHtml(facts), ProvenanceHtml(facts));
  html += CoursesHtml(pages);
  for (const NamedFigure& figure : ArchiveFigures(facts)) html += FigureHtml(figure, facts.directory);
  html += SearchesTable(facts.summary) + CommandsHtml(facts);
  return html + fmt::format(
                    "<details><summary>The whole experiment, as it was resolved</summary><pre>{}</pre>"
                    "</details>\n",
                    HtmlLines(facts.experiment_toml));
}

}  // namespace gauntlet
