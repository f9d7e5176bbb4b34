// The report: one HTML document about one or several campaigns. As a file it needs nothing else to be read;
// served, its scripts ask for what it does not hold.
#pragma once

#include <string>
#include <vector>

#include "report/pages/campaign_pages.h"
#include "report/pages/study_pages.h"

namespace gauntlet {

struct Report {
  std::vector<CampaignPages> campaigns;  // at least one
  std::vector<StudyPages> studies = {};
  SetComparisons comparisons = {};  // empty of a single set
  // By `gauntlet ui`: with a live page, and every run at hand.
  bool served = false;
};

// Of the campaigns that the sets name, each once, with `shown_runs` replays shared by them; several sets are
// compared. A study's directory stands for its campaigns and for what it has found. Errors: those of
// SplitSet, GatherPages, GatherStudy and CompareSets.
Result<Report> GatherReport(const std::vector<std::string>& sets, std::size_t shown_runs);

// The directories of the campaigns that the sets name now, in the order of the report; a study that goes on
// has more of them later. Errors: those of SplitSet, a study has none yet.
Result<std::vector<std::string>> CampaignsNamed(const std::vector<std::string>& sets);

// The document. A file asks the network for nothing and forbids the browser to, a served one asks its own
// server only; without JavaScript its pages stand one below the other, with every table. The same bytes for
// the same report.
std::string ReportPage(const Report& report);

}  // namespace gauntlet
