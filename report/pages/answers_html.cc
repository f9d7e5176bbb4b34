#include "report/pages/answers_html.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "analysis/figures/layout_strip.h"
#include "analysis/figures/run/run_thumbnail.h"
#include "analysis/tables/section.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "proto/run_text.h"
#include "report/pages/html_text.h"
#include "report/tables/distinct_failures.h"
#include "report/tables/next_commands.h"
#include "search/given/layout_question.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostFailures = 12;   // that are listed
constexpr std::size_t kMostMinimised = 24;  // that are drawn
constexpr double kTypicalPixels = 220.0;

// The case's name, with a link where its run can be shown.
std::string CaseLink(const CampaignPages& pages, std::size_t number, const std::string& name, RunId run) {
  const std::string link = pages.LinkTo(number, run);
  return link.empty() ? Html(name) : fmt::format("<a href=\"{}\">{}</a>", link, Html(name));
}

// "24 of 30"
std::string OutOf(const proto::CaseFailures& found) {
  return fmt::format("{} of {}", found.failures, found.runs);
}

// The case beside what is left of it.
std::string DrawSmallest(const SmallestLayout& one) {
  const proto::CaseLineage& lineage = *one.document.lineage;
  const auto picture = [](const char* heading, const sim::Genome& obstacles, const std::string& outcome) {
    return analysis::LayoutPicture{
        .heading = heading, .outcome = outcome, .obstacles = obstacles, .kept = AllOf(obstacles).kept};
  };
  analysis::LayoutStrip strip{
      .title = fmt::format("run {}: from {} obstacles to {}", proto::RunText(one.run),
                           lineage.parent.obstacles.size(), one.document.test_case.obstacles.size()),
      .original = lineage.parent,
      .pictures = {},
      .places = {}};
  if (!lineage.steps.empty())
    strip.pictures.push_back(picture("as it is", lineage.parent.obstacles,
                                     fmt::format("failed in {} runs", OutOf(lineage.steps.front().found))));
  strip.pictures.push_back(picture("what is left", one.document.test_case.obstacles,
                                   fmt::format("fails in {} fresh runs", OutOf(lineage.verified))));
  if (!lineage.steps.empty()) {
    strip.pictures.back().kept.clear();
    for (const int obstacle : lineage.steps.back().obstacles)
      strip.pictures.back().kept.push_back(static_cast<std::size_t>(obstacle - 1));
  }
  return analysis::DrawLayoutStrip(strip);
}

// Whether a run is one of the case.
bool IsOf(const CampaignFacts& facts, RunId run, const CaseFacts& of_case) {
  const auto found = std::ranges::find(facts.runs, run, &RunFacts::id);
  return found != facts.runs.end() && found->search == of_case.search &&
         found->individual == of_case.individual;
}

// A thumbnail for each distinct failure: a run that fails as most of its case do.
std::string TypicalRunsHtml(const CampaignPages& pages, std::size_t number) {
  const CampaignAnswers& answers = pages.facts.answers;
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  const auto failures = distinct.All();
  std::string html;
  for (std::size_t i = 0; i < std::min(failures.size(), pages.typical.size()); ++i) {
    if (pages.typical[i].figure.result.trajectory.empty()) continue;
    const Confirmation& toughest = *failures[i]->cases.front();
    html += fmt::format("<li><img alt=\"\" width=\"220\" height=\"220\" src=\"{}\">{}: {}</li>\n",
                        DataUri(analysis::DrawThumbnail(pages.typical[i].figure, kTypicalPixels)),
                        Html(failures[i]->name), CaseLink(pages, number, toughest.name, toughest.run));
  }
  return html.empty()
             ? ""
             : fmt::format(
                   "<p>A typical run of each, with fresh seeds:</p>\n<ul class=\"thumbs\">\n{}</ul>\n", html);
}

}  // namespace

std::string DistinctFailuresHtml(const CampaignPages& pages, std::size_t number) {
  const CampaignFacts& facts = pages.facts;
  const std::vector<Confirmation>& confirmations = facts.answers.confirmations;
  if (confirmations.empty()) {
    if (facts.summary.total_failures == 0 && facts.summary.failing_runs == 0) return "";
    return ToHtml({.title = "Distinct failures",
                   .commands = {{ConfirmCommand(facts.summary, "gauntlet", facts.directory),
                                 "How many different failures these are, and whether they happen again with "
                                 "fresh seeds, is not known yet. This finds it out"}}});
  }
  std::string html;
  for (const Section& section : TellDistinctFailures(facts.answers, kMostFailures, "gauntlet",
                                                     [&](RunId run) { return pages.LinkTo(number, run); }))
    html += ToHtml(section);
  return html + TypicalRunsHtml(pages, number);
}

std::string MinimisedCasesHtml(const CampaignPages& pages, std::size_t number) {
  std::vector<SmallestLayout> layouts = pages.facts.answers.smallest_layouts;
  std::erase_if(layouts, std::not_fn(&SmallestLayout::Smaller));
  if (layouts.empty()) return "";
  std::string html =
      "<h3>The few obstacles that do it</h3>\n<p>Cases beside the smallest part of them that still breaks "
      "the "
      "swarm in the same way; what was taken away stands faintly.</p>\n<ul class=\"thumbs pairs\">\n";
  for (const SmallestLayout& one : std::span(layouts).first(std::min(kMostMinimised, layouts.size()))) {
    html +=
        fmt::format("<li><img alt=\"\" src=\"{}\">{}: {} of {} are left</li>\n", DataUri(DrawSmallest(one)),
                    CaseLink(pages, number, fmt::format("run {}", proto::RunText(one.run)), one.run),
                    one.document.test_case.obstacles.size(),
                    Counted(one.document.lineage->parent.obstacles.size(), "obstacle"));
  }
  return html + "</ul>\n";
}

std::string SmallestLayoutsHtml(const CampaignPages& pages, std::size_t number) {
  const CampaignAnswers& answers = pages.facts.answers;
  std::string html;
  for (const SmallestLayout* layout : SmallestFirst(answers.smallest_layouts, pages.smallest.size())) {
    const auto run = pages.smallest.find(layout->run);
    if (run == pages.smallest.end() || run->second.figure.result.trajectory.empty()) continue;
    const auto known = std::ranges::find(answers.confirmations, layout->run, &Confirmation::run);
    const FailedRun* typical = known == answers.confirmations.end() ? nullptr : known->Typical();
    const std::string what =
        typical == nullptr || typical->features.mechanism.empty() ? "" : "; " + typical->features.mechanism;
    html += fmt::format(
        "<li><img alt=\"\" width=\"220\" height=\"220\" src=\"{}\">{}: fails in {} runs{} ({})</li>\n",
        DataUri(analysis::DrawThumbnail(run->second.figure, kTypicalPixels)),
        Counted(layout->document.test_case.obstacles.size(), "obstacle"),
        OutOf(layout->document.lineage->verified), Html(what),
        CaseLink(pages, number, fmt::format("run {}", proto::RunText(layout->run)), layout->run));
  }
  if (html.empty()) return "";
  return fmt::format(
      "<h3>The smallest layouts that break it</h3>\n<p>What is left of a case when every obstacle that is "
      "not "
      "needed is taken away, and a run in it: the trajectories of robots that did well are blue, of those "
      "that "
      "were lost red.</p>\n<ul class=\"thumbs pairs\">\n{}</ul>\n",
      html);
}

std::string AnswersHtml(const CampaignFacts& facts, const CaseFacts& of_case) {
  std::string html;
  for (const ToldCase& one : facts.told_cases) {
    if (IsOf(facts, one.run, of_case)) html += ToHtml(one.section);
  }
  return html;
}

}  // namespace gauntlet
