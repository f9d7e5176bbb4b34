#include "report/pages/report_page.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "report/pages/base64.h"
#include "report/pages/front_end.h"
#include "report/pages/html_text.h"
#include "report/pages/report_document.h"
#include "study/sets/subset.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

std::string TitleOf(const Report& report) {
  std::string title = report.studies.empty() ? report.campaigns.front().facts.summary.experiment
                                             : report.studies.front().name;
  if (report.studies.empty() && report.campaigns.size() > 1)
    title += fmt::format(" and {} more", report.campaigns.size() - 1);
  return title;
}

std::string HeadHtml(const std::string& title, const std::string& script, bool served) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:{0}; {1}"
      "style-src 'unsafe-inline'; script-src '{2}'; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{3}: Gauntlet report</title>\n"
      "<link rel=\"icon\" href=\"data:,\">\n<style>\n{4}</style>\n</head>\n",
      served ? " 'self'" : "", served ? "connect-src 'self'; " : "", ScriptHash(script), Html(title),
      kPageStyle);
}

// The first run that has a page; "" when there is none.
std::string FirstCase(const Report& report) {
  for (std::size_t i = 0; i < report.campaigns.size(); ++i) {
    const auto& shown = report.campaigns[i].shown;
    if (!shown.empty()) return IdOfRun(i, shown.front().report.stored.id);
  }
  return "";
}

// Whoever names several sets asks for their comparison.
bool ComparisonFirst(const Report& report) {
  return !report.comparisons.comparisons.empty();
}

// The pages that a report has besides those of its campaigns.
struct OtherPages {
  std::string comparison;
  std::string parameters;
};

OtherPages OtherPagesOf(const Report& report) {
  OtherPages pages;
  for (const StudyPages& study : report.studies) {
    pages.comparison += StudyResultsHtml(study);
    pages.parameters += ParametersHtml(study);
  }
  const SetComparisons& sets = report.comparisons;
  if (!sets.comparisons.empty()) pages.comparison += ComparisonHtml(sets.comparisons, sets.notes);
  return pages;
}

std::string NavigationHtml(const Report& report, const OtherPages& others) {
  const std::string comparison = others.comparison.empty() ? "" : "<a href=\"#comparison\">Comparison</a>\n";
  std::string html = "<nav aria-label=\"Pages\">\n" + (ComparisonFirst(report) ? comparison : "") +
                     "<a href=\"#overview\">Overview</a>\n<a href=\"#failures\">Failures</a>\n";
  if (const std::string first = FirstCase(report); !first.empty())
    html += fmt::format("<a href=\"#{}\" data-page=\"case\">A run</a>\n", first);
  if (!ComparisonFirst(report)) html += comparison;
  if (!others.parameters.empty()) html += "<a href=\"#parameters\">Parameters</a>\n";
  if (report.served) html += "<a href=\"#live\">Live</a>\n";
  return html + "</nav>\n";
}

// "" of a page without content.
std::string SectionHtml(const char* id, const std::string& html) {
  if (html.empty()) return "";
  return fmt::format("<section class=\"page\" id=\"{}\">\n{}</section>\n", id, html);
}

// Of several campaigns, the figures that count beside one another.
std::string CampaignsTable(const Report& report) {
  if (report.campaigns.size() < 2) return "";
  Table table({"campaign", "scenario", "controller", ">runs", ">total failures", "finished"});
  for (const CampaignPages& one : report.campaigns) {
    const CampaignSummary& summary = one.facts.summary;
    const Experiment& experiment = one.facts.plans.front().experiment;
    table.AddRow({one.facts.directory, experiment.scenario, experiment.controller,
                  CountCell(summary.runs_done), CountCell(summary.total_failures), summary.finished});
  }
  return "<h2>The campaigns</h2>\n" + table.ToHtml();
}

// What goes on now; scripts fill it.
std::string LiveHtml(const Report& report) {
  if (!report.served) return "";
  std::string html = "<section class=\"page\" id=\"live\">\n";
  for (std::size_t i = 0; i < report.campaigns.size(); ++i) {
    const CampaignFacts& facts = report.campaigns[i].facts;
    html += CampaignHeading(facts) + fmt::format("<div class=\"live\" data-campaign=\"{}\"></div>\n", i);
  }
  return html + "</section>\n";
}

// What the sets name, each once.
struct Named {
  std::vector<std::string> campaigns;
  std::vector<std::string> studies;
  std::vector<std::string> compared;  // sets of runs: all but studies
};

void AddOnce(const std::string& path, std::vector<std::string>& paths) {
  if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
}

Result<Named> WhatSetsName(const std::vector<std::string>& sets) {
  Named named;
  for (const std::string& set : sets) {
    if (IsStudy(set)) {
      const std::vector<std::string> campaigns = CampaignsIn(set);
      if (campaigns.empty())
        return InvalidInput(fmt::format("{} holds a study that has not begun: `gauntlet resume {}` begins it",
                                        set, PastedPath(set)));
      AddOnce(set, named.studies);
      for (const std::string& campaign : campaigns) AddOnce(campaign, named.campaigns);
      continue;
    }
    TRY(const std::vector<SetPart> parts, SplitSet(set));
    for (const SetPart& part : parts) AddOnce(part.path, named.campaigns);
    named.compared.push_back(set);
  }
  return named;
}

}  // namespace

Result<Report> GatherReport(const std::vector<std::string>& sets, std::size_t shown_runs) {
  TRY(const Named named, WhatSetsName(sets));
  Report report;
  for (const std::string& directory : named.studies) {
    TRY(StudyPages study, GatherStudy(directory));
    report.studies.push_back(std::move(study));
  }
  for (const std::string& directory : named.campaigns) {
    TRY(CampaignPages pages, GatherPages(directory, shown_runs / named.campaigns.size()));
    report.campaigns.push_back(std::move(pages));
  }
  if (named.compared.size() < 2) return report;
  TRY(report.comparisons, CompareSets(named.compared));
  return report;
}

Result<std::vector<std::string>> CampaignsNamed(const std::vector<std::string>& sets) {
  TRY(Named named, WhatSetsName(sets));
  return std::move(named.campaigns);
}

std::string ReportPage(const Report& report) {
  std::string overview;
  for (const StudyPages& study : report.studies) overview += StudyOverviewHtml(study);
  std::string failures;
  std::string cases;
  for (std::size_t i = 0; i < report.campaigns.size(); ++i) {
    overview += OverviewHtml(report.campaigns[i], i);
    failures += FailuresHtml(report.campaigns[i], i);
    if (!report.served) cases += CasesHtml(report.campaigns[i], i);  // a server gives them one by one
  }
  overview += CampaignsTable(report);
  const SetComparisons& comparisons = report.comparisons;
  if (comparisons.comparisons.empty()) overview += ComparisonHtml({}, comparisons.notes);
  const OtherPages others = OtherPagesOf(report);
  const std::string comparison = SectionHtml("comparison", others.comparison);
  const std::string script = fmt::format("\n{}", kPageScript);
  return HeadHtml(TitleOf(report), script, report.served) +
         fmt::format(
             "<body>\n<a class=\"skip\" href=\"#overview\">To the overview</a>\n<header><h1>Gauntlet "
             "report</h1>\n"
             "<p class=\"soft\">Where does the swarm's controller break? Gauntlet simulates a swarm of "
             "robots in obstacle courses (test cases), searches for courses in which it fails, and "
             "tells where, how often and how. A run is one simulation; its fitness says how well the "
             "swarm did, lower means a tougher course.</p></header>\n<main>\n{}",
             NavigationHtml(report, others)) +
         (ComparisonFirst(report) ? comparison : "") + SectionHtml("overview", overview) +
         SectionHtml("failures", failures) + cases + (ComparisonFirst(report) ? "" : comparison) +
         SectionHtml("parameters", others.parameters) + LiveHtml(report) +
         fmt::format(
             "</main>\n<footer>Made by Gauntlet. {}</footer>\n"
             "<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script>\n"
             "</body>\n</html>\n",
             report.served ? "Served by gauntlet ui, to this machine only."
                           : "This file needs no network and no other file.",
             JsonInHtml(ReportDocument(report)), script);
}

}  // namespace gauntlet
