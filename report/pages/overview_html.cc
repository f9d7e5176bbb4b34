#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "analysis/tables/section.h"
#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "report/figures/campaign_figures.h"
#include "report/figures/condition_figure.h"
#include "report/figures/settings/settings_answer.h"
#include "report/pages/answers_html.h"
#include "report/pages/campaign_pages.h"
#include "report/pages/html_text.h"
#include "report/tables/conditions.h"
#include "report/tables/next_commands.h"
#include "report/tables/summary_tables.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kCoursesAtOnce = 3;
constexpr std::size_t kMostBlocks = 12;  // of a search's course

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
  const auto described = [](const std::string& name, const auto* row) {
    return row == nullptr ? name : fmt::format("{}: {}", name, row->description);
  };
  Table table({"", ""});
  table.AddRow({"scenario", described(experiment.scenario, scenario)});
  table.AddRow({"controller under test", described(experiment.controller, controller)});
  table.AddRow({"search", facts.plans.size() == 1
                              ? fmt::format("{}: {}", search.title,
                                            search.plan == nullptr ? "" : search.plan(experiment))
                              : fmt::format("{} searches in one campaign", facts.plans.size())});
  if (ConditionsOf(summary).size() > 1) {
    table.AddRow({"runs", FormatCount(summary.runs_done)});
  } else {
    AddTally(summary, summary.OnlySearch(), table);
  }
  AddReproducibility(summary, table);
  table.AddRow({"state", summary.finished ? "finished" : "not finished"});
  return table.ToHtml();
}

std::string ProvenanceHtml(const CampaignFacts& facts) {
  std::vector<std::string> seeds;
  for (const SearchPlan& plan : facts.plans) {
    const std::string seed = fmt::format("{}", plan.experiment.seed);
    if (std::ranges::find(seeds, seed) == seeds.end()) seeds.push_back(seed);
  }
  const CampaignHistory& history = facts.history;
  Table table({"", ""});
  table.AddRow({"made by", fmt::format("gauntlet {}", facts.software_version)});
  table.AddRow({"golden hashes", facts.golden_hashes});
  table.AddRow({seeds.size() == 1 ? "seed" : "seeds", Listed(seeds)});
  table.AddRow({"hosts of workers", Listed(history.hosts)});
  table.AddRow({"created", TimeText(history.created_unix_ms)});
  table.AddRow({"last event", TimeText(history.last_unix_ms)});
  table.AddRow(
      {"time served", fmt::format("{} in {} {}", FormatDuration(history.served_seconds), history.sessions,
                                  history.sessions == 1 ? "session" : "sessions")});
  return table.ToHtml();
}

// The command that makes the same campaign again; "" where there is no single one.
std::string AgainCommand(const CampaignFacts& facts) {
  const SearchRow& row = RowOf(facts.plans.front().experiment);
  if (facts.plans.size() != 1 || row.given_cases() || row.streamed) return "";
  const std::string toml = PastedPath(facts.directory + "/experiment.toml");
  const std::string length =
      row.length_option.empty()
          ? ""
          : fmt::format(" {} {}", row.length_option, facts.summary.progress.evaluations_planned);
  return fmt::format("gauntlet {} {}{} --dir again", row.command, toml, length);
}

std::string CommandsHtml(const CampaignFacts& facts) {
  const std::string dir = PastedPath(facts.directory);
  Section section{.title = "Commands"};
  for (NextCommand& one : NextCommandsOf(facts.summary, facts.answers, "gauntlet", facts.directory)) {
    if (one.command == ConfirmCommand(facts.summary, "gauntlet", facts.directory)) continue;  // stands above
    one.purpose.front() = static_cast<char>(std::toupper(one.purpose.front()));
    section.commands.push_back(std::move(one));
  }
  if (const std::string again = AgainCommand(facts); !again.empty()) {
    section.commands.push_back({again, "The same campaign once more; it must end with the same state hash"});
    section.commands.push_back({"gauntlet show again", "Its state hash"});
  }
  if (!facts.summary.finished)
    section.commands.push_back(
        {GoOnCommand(facts.summary, "gauntlet", facts.directory), "Go on where it stopped"});
  section.commands.push_back(
      {fmt::format("gauntlet export {} --format csv --out runs.csv", dir), "Every run as a table"});
  return ToHtml(section);
}

// A search's course in numbers: the first part, the last, and some at even distances between them.
std::string CourseTable(const SearchCourse& course) {
  Table table({">runs spent", ">toughest fitness", ">mean fitness", ">total failures"});
  for (const CourseBlock& block :
       course.repeats.empty() ? std::vector<CourseBlock>() : course.repeats.front()) {
    table.AddRow({CountCell(block.runs), FitnessCell(block.fitness.lowest()),
                  FitnessCell(block.fitness.mean()), fmt::format("{:.1f} %", 100.0 * block.failure_share)});
  }
  return fmt::format("<details><summary>{}</summary>{}</details>\n",
                     course.repeats.size() > 1 ? "The first of these searches in numbers" : "In numbers",
                     table.Thinned(kMostBlocks).ToHtml());
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

std::string SearchesHtml(const CampaignSummary& summary) {
  constexpr std::size_t kMostSearches = 100;
  const std::size_t searches = summary.searches.size();
  if (searches == 1) return "";
  return fmt::format("<details><summary>The {}{} searches</summary>{}</details>\n",
                     searches > kMostSearches ? fmt::format("first {} of ", kMostSearches) : "", searches,
                     SearchesTable(summary, kMostSearches).ToHtml());
}

// Of a sweep, what it was made for.
std::string ConditionsHtml(const CampaignFacts& facts) {
  constexpr std::size_t kMostConditions = 100;
  const std::vector<Condition> conditions = ConditionsOf(facts.summary);
  if (conditions.size() < 2) return "";
  std::string html;
  for (const NamedFigure& figure : ConditionFigures(facts)) html += FigureHtml(figure, facts.directory);
  if (html.empty()) html = "<h3>How often it fails under each condition</h3>\n";
  return html + ConditionsTable(conditions).First(kMostConditions).ToHtml();
}

// What a search over settings has found; what became of single runs is not what it is about.
std::string SettingsHtml(const CampaignFacts& facts, const SettingsAnswer& answer) {
  std::string html;
  for (const Section& section : answer.sections) html += ToHtml(section);
  for (const NamedFigure& figure : answer.figures) html += FigureHtml(figure, facts.directory);
  return html;
}

}  // namespace

std::string CampaignHeading(const CampaignFacts& facts) {
  return fmt::format("<h2>{} <span class=\"soft\">{}</span></h2>\n", Html(facts.summary.experiment),
                     Html(facts.directory));
}

std::string OverviewHtml(const CampaignPages& pages, std::size_t number) {
  const CampaignFacts& facts = pages.facts;
  std::string html =
      CampaignHeading(facts) + fmt::format("<p class=\"verdict\">{}</p>\n", Html(VerdictOf(pages)));
  if (!facts.notes.empty()) {
    html += "<ul class=\"notes\">\n";
    for (const std::string& note : facts.notes) html += fmt::format("<li>{}</li>\n", Html(note));
    html += "</ul>\n";
  }
  html += ConditionsHtml(facts) + SmallestLayoutsHtml(pages, number);
  const std::optional<SettingsAnswer> settings = SettingsAnswerOf(facts);
  html += settings ? SettingsHtml(facts, *settings)
                   : ToughestRunsHtml(pages, number) + DistinctFailuresHtml(pages, number);
  html += fmt::format(
      "<div class=\"columns\"><div><h3>What was tested</h3>\n{}</div>\n<div><h3>Where it comes "
      "from</h3>\n{}</div></div>\n",
      TestedHtml(facts), ProvenanceHtml(facts));
  if (!settings) html += CoursesHtml(pages);
  html += SearchesHtml(facts.summary) + CommandsHtml(facts);
  return html + fmt::format("<details><summary>{}, as it was resolved</summary><pre>{}</pre></details>\n",
                            facts.plans.size() == 1
                                ? std::string("The whole experiment")
                                : fmt::format("The first of the {} experiments", facts.plans.size()),
                            HtmlLines(facts.experiment_toml));
}

}  // namespace gauntlet
