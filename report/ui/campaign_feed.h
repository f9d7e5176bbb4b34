// The runs and events of a campaign, followed while it goes on.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/store/result_store.h"
#include "report/figures/campaign_facts.h"
#include "report/figures/search_course.h"

namespace gauntlet {

// Each look reads only runs that it has not seen. Thread-safety: one calling thread at a time.
class CampaignFeed {
 public:
  explicit CampaignFeed(std::string directory);

  // Reads what has been stored since the last look. Another campaign in the same directory is read anew.
  // Errors: those of ViewCampaign, ReadSearchPlans and of reading; what was seen before then stands.
  Status Look();

  std::vector<SearchCourse> courses() const { return CoursesOf(facts_); }
  // The newest, at most kMostEvents, oldest first.
  const std::vector<StoredEvent>& events() const { return events_; }
  // The run of lowest fitness, of equal ones the earliest; nullptr without any.
  const RunFacts* toughest() const;

  static constexpr std::size_t kMostEvents = 40;

 private:
  // Runs of a search that follow on one another without a gap; what was stored out of order is read again.
  Status ReadRunsOf(SearchId search, ResultStore& store);

  std::string campaign_id_;
  CampaignFacts facts_;      // directory, plans and runs only
  std::vector<RunId> seen_;  // by search: all up to this run
  std::vector<StoredEvent> events_;
};

}  // namespace gauntlet
