#include "report/pages/campaign_pages.h"
#include "report/tables/conditions.h"

#include <algorithm>

namespace gauntlet {
namespace {

constexpr std::size_t kMostSmallest = 3;  // layouts that an overview begins with

}  // namespace

bool CampaignPages::HasPage(RunId run) const {
  if (every_run) return run != 0;
  return std::ranges::any_of(shown, [run](const ShownRun& one) { return one.report.stored.id == run; });
}

std::string CampaignPages::LinkTo(std::size_t number, RunId run) const {
  return HasPage(run) ? "#" + IdOfRun(number, run) : "";
}

Result<CampaignPages> GatherPages(const std::string& dir, std::size_t most_shown) {
  TRY(CampaignFacts facts, ReadFacts(dir));
  CampaignPages pages{.facts = std::move(facts), .courses = {}, .maps = {}, .shown = {}, .typical = {}};
  pages.courses = CoursesOf(pages.facts);
  // Runs under several conditions are not counted in one map.
  if (ConditionsOf(pages.facts.summary).size() == 1) pages.maps = MapsOf(pages.facts);
  TRY(pages.shown, ShowRuns(pages.facts, RunsToShow(pages.facts, pages.maps, most_shown)));
  const CampaignAnswers& answers = pages.facts.answers;
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  auto failures = distinct.All();
  failures.resize(std::min(failures.size(), most_shown));
  TRY(pages.typical, ShowTypicalRuns(pages.facts, failures));
  TRY(pages.smallest, ShowSmallest(pages.facts, SmallestFirst(answers.smallest_layouts,
                                                              std::min(most_shown, kMostSmallest))));
  return pages;
}

}  // namespace gauntlet
