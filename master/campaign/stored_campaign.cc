#include "master/campaign/stored_campaign.h"

#include <utility>

#include <fmt/format.h>

#include "master/campaign/stored_check.h"

namespace gauntlet {

Result<StoredCampaign> OpenStoredCampaign(const std::string& dir) {
  Result<CampaignView> view = ViewCampaign(dir, Checked::kRows);
  if (!view) return view.error();
  Result<std::vector<SearchPlan>> plans = ReadSearchPlans(view->directory);
  if (!plans) return plans.error();
  if (Status whole = CheckStored(*plans, *view->store, Checked::kRows); !whole) return whole.error();
  std::string being_written;
  if (view->lock == nullptr) {
    being_written = fmt::format("{} is being written: its runs {}", dir,
                                view->as_of.empty() ? "as they were stored just now" : view->as_of);
  }
  return StoredCampaign{*std::move(view), *std::move(plans), std::move(being_written)};
}

}  // namespace gauntlet
