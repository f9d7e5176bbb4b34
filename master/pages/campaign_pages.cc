#include "master/pages/campaign_pages.h"

namespace gauntlet::master {

Result<CampaignPages> GatherPages(const std::string& dir, std::size_t most_shown) {
  Result<CampaignFacts> facts = ReadFacts(dir);
  if (!facts) return facts.error();
  CampaignPages pages{*std::move(facts), {}, {}, {}};
  pages.courses = CoursesOf(pages.facts);
  pages.maps = MapsOf(pages.facts);
  Result<std::vector<ShownRun>> shown =
      ShowRuns(pages.facts, RunsToShow(pages.facts, pages.maps, most_shown));
  if (!shown) return shown.error();
  pages.shown = *std::move(shown);
  return pages;
}

}  // namespace gauntlet::master
