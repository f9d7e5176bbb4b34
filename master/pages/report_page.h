// The report: one HTML file about one or several campaigns that needs nothing else to be read.
#pragma once

#include <string>
#include <vector>

#include "master/pages/campaign_pages.h"

namespace gauntlet::master {

struct Report {
  std::vector<CampaignPages> campaigns;  // at least one
  SetComparisons comparisons;            // empty of a single set
};

// The document. It asks the network for nothing and forbids the browser to; without JavaScript its pages
// stand one below the other, with every table. The same bytes for the same report.
std::string ReportPage(const Report& report);

}  // namespace gauntlet::master
