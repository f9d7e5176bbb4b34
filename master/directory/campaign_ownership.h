// Lock, epoch and store of a campaign, taken in the one order that is safe.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/campaign_lock.h"
#include "master/directory/campaign_origin.h"
#include "master/store/sqlite_store.h"

namespace gauntlet {

// What a master holds while it serves a campaign. Destroying it commits what still waits, closes the store
// and releases the lock, in this order.
struct CampaignOwnership {
  CampaignDirectory directory;
  std::unique_ptr<CampaignLock> lock;
  std::uint64_t epoch = 0;
  CampaignOrigin origin;
  // Whether the campaign is still this master's: kInUse once a newer master has started or the lock is lost,
  // kNotFound once the directory or a file that must not change was deleted or replaced. An epoch or a
  // description of the campaign that was deleted is written again. Thread-safe.
  std::function<Status()> check;
  // Commits nothing any more once `check` fails.
  std::unique_ptr<SqliteStore> store;
};

// Files of a campaign that say what it is to do; "" = there is none.
struct CampaignTexts {
  std::string experiment;     // experiment.toml
  std::string searches = "";  // searches.json
  std::string slurm = "";     // slurm.toml
  // Writes what else the searches need, before the campaign exists; may be empty.
  std::function<Status(const CampaignDirectory&)> others = nullptr;
};

// Makes a campaign in `dir` and takes it. `meta.campaign_id` and
// `meta.created_unix_ms` are filled in. `fill` says what the store begins with: it is there as soon as the
// campaign is. A master that is killed in here leaves nothing that keeps the next one from doing the same
// again. Errors: those of CampaignDirectory::Create and CampaignLock::Acquire; kNoSpace, kIo.
Result<CampaignOwnership> CreateCampaign(const std::string& dir, const CampaignTexts& texts,
                                         CampaignMeta meta,
                                         const std::function<Status(ResultStore&)>& fill = nullptr);

enum class LivingMaster {
  kRespect,  // kInUse
  kFence,    // its epoch becomes outdated, which makes it stop; waited for until its lock is stale
};

// Takes an existing campaign, which may mean waiting for those who read it: `give_up` is asked meanwhile, and
// true ends the wait. Errors: those of CampaignDirectory::Open and CheckTrusted, CampaignLock::Acquire and
// SqliteStore::Open.
Result<CampaignOwnership> TakeCampaign(
    const std::string& dir, LivingMaster other = LivingMaster::kRespect,
    const std::function<bool()>& give_up = [] { return false; });

// A campaign to look at. Without a living master: masters wait meanwhile, and no byte of the directory
// changes, which may be read-only. Beside a master of this machine: what it has committed by now; it does not
// wait. Beside one of another machine: the newest snapshot that it has published.
struct CampaignView {
  CampaignDirectory directory;
  std::unique_ptr<CampaignLock> lock;  // none beside a master
  std::unique_ptr<SqliteStore> store;
  std::string as_of = "";  // of a snapshot, "as of 14:03, on node7"
};
// Errors: those of CampaignDirectory::Open and SqliteStore::OpenReadOnly; kInUse when a master just starts or
// ends, or when one on another machine has published no snapshot yet.
Result<CampaignView> ViewCampaign(const std::string& dir, Checked what = Checked::kEverything);

}  // namespace gauntlet
