#include "master/campaign/stored_campaign.h"

#include <utility>

#include <fmt/format.h>

#include "master/campaign/stored_check.h"

namespace gauntlet {

Result<StoredCampaign> OpenStoredCampaign(const std::string& dir) {
  TRY(CampaignView view, ViewCampaign(dir, Checked::kRows));
  TRY(std::vector<SearchPlan> plans, ReadSearchPlans(view.directory));
  TRY(CheckStored(plans, *view.store, Checked::kRows));
  std::string being_written;
  if (view.lock == nullptr) {
    being_written = fmt::format("{} is being written: its runs {}", dir,
                                view.as_of.empty() ? "as they were stored just now" : view.as_of);
  }
  return StoredCampaign{std::move(view), std::move(plans), std::move(being_written)};
}

}  // namespace gauntlet
