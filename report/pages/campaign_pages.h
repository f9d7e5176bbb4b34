// What a report's pages show of one campaign.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "analysis/tables/table.h"
#include "base/result.h"
#include "report/figures/campaign_facts.h"
#include "report/figures/run_map.h"
#include "report/figures/search_course.h"
#include "report/figures/set_comparison.h"
#include "report/figures/shown_run.h"

namespace gauntlet {

struct CampaignPages {
  CampaignFacts facts;
  std::vector<SearchCourse> courses;
  std::vector<RunMap> maps;
  std::vector<ShownRun> shown;
  std::vector<ShownRun> typical =
      {};  // of the first distinct failures, in the order of DistinctFailures::All
  std::map<RunId, ShownRun> smallest = {};  // by the run whose case was made smaller
  bool every_run = false;                   // others than those shown can be had too: pages that are served

  bool HasPage(RunId run) const;
  // "#run-0-981", of the campaign of this number; "" where the run has no page.
  std::string LinkTo(std::size_t number, RunId run) const;
};

// Error: those of ReadFacts and ShowRuns.
Result<CampaignPages> GatherPages(const std::string& dir, std::size_t most_shown);

// The parts of the pages; `number`: of the campaign in the report, from 0, which all ids within the page
// have. Everything is HTML.

// What was tested, and what came of it, in two or three sentences; a text.
std::string VerdictOf(const CampaignPages& pages);
// Its name and its directory: begins every page about it.
std::string CampaignHeading(const CampaignFacts& facts);
std::string OverviewHtml(const CampaignPages& pages, std::size_t number);
// What became of the test cases, the `most` toughest, where a run's page is ("" or no function: nowhere), and
// by which keys scripts know it.
Table CaseTable(const CampaignFacts& facts, std::size_t most,
                const std::function<std::string(RunId)>& link = nullptr);
// Pictures of the toughest cases, each with its run, of a campaign of which nothing smaller or more typical
// is known; else "".
std::string ToughestRunsHtml(const CampaignPages& pages, std::size_t number);
std::string FailuresHtml(const CampaignPages& pages, std::size_t number);
// A page for each run that is shown.
std::string CasesHtml(const CampaignPages& pages, std::size_t number);
// One of them.
std::string CaseHtml(const CampaignFacts& facts, std::size_t number, const ShownRun& shown);
std::string ComparisonHtml(const std::vector<SetComparison>& comparisons,
                           const std::vector<std::string>& notes);

// The id of a run's page.
std::string IdOfRun(std::size_t number, RunId run);

}  // namespace gauntlet
