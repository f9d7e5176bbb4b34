// The files by which a living master is found, followed and asked to stop.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/result.h"
#include "master/directory/campaign_directory.h"

namespace gauntlet::master {

// Removes access.json, status.json and `stop` at its end, unless a newer master has written its own.
class MasterFiles {
 public:
  // `epoch`: the master's start number. The directory outlives the object.
  MasterFiles(const CampaignDirectory& directory, std::uint64_t epoch)
      : directory_(directory), epoch_(epoch) {}
  MasterFiles(const MasterFiles&) = delete;
  MasterFiles& operator=(const MasterFiles&) = delete;
  ~MasterFiles();

  // kInUse when a newer master has begun: what lies in the directory is then its own.
  Status CheckNewest() const { return directory_.CheckEpoch(epoch_); }
  // Whether `gauntlet stop` was here.
  bool StopRequested() const;
  // Replaces status.json.
  Status PublishStatus(std::string_view json) const;

 private:
  const CampaignDirectory& directory_;
  const std::uint64_t epoch_;
};

}  // namespace gauntlet::master
