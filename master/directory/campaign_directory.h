// The directory of a campaign: its files and the number of its newest master. It can be moved and copied;
// nothing in it is an absolute path.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/result.h"
#include "base/system/regular_file.h"

namespace gauntlet {

// Which content a file has, by what can be asked without opening it.
struct FileVersion {
  FileId file;
  std::int64_t modified_seconds = 0;
  std::int64_t modified_nanoseconds = 0;
  bool operator==(const FileVersion&) const = default;
};

// Of the file or the link of this name; nothing when there is none, or it cannot be looked at (errno).
std::optional<FileVersion> VersionOf(const std::string& path);

class CampaignDirectory {
 public:
  // Whether Create would take `dir`; makes nothing. It takes no directory in which others may write.
  static Status CheckCreatable(const std::string& dir);
  // Makes `dir`, and the directories above it. kInvalidInput, naming `gauntlet resume`, when it holds a
  // campaign, and when it holds anything else but what a creation that was killed has left.
  static Result<CampaignDirectory> Create(const std::string& dir);
  // kNotFound when there is no such directory or no campaign in it. Whether the database can be read is the
  // store's business.
  static Result<CampaignDirectory> Open(const std::string& dir);

  // Whether there is a campaign, finished or not, as far as can be seen.
  static bool IsCampaign(const std::string& dir);

  // Whether nobody but this user (and root) could have written what the directory holds: to be asked before
  // anything is obeyed that stands there. kInvalidInput says who could, and the way out.
  Status CheckTrusted() const;
  // The campaign that this path, without links, names a file of: one that masters write or obey.
  static std::optional<std::string> Owning(const std::string& path);

  const std::string& path() const { return path_; }
  std::string experiment_path() const { return path_ + "/experiment.toml"; }
  // The campaign exists from the moment this file does.
  std::string database_path() const { return path_ + "/campaign.db"; }
  // What a living master has stored so far, for those who look at it from another machine.
  std::string snapshot_path() const { return path_ + "/snapshot.db"; }
  std::string epoch_path() const { return path_ + "/epoch"; }
  std::string lock_path() const { return path_ + "/lock"; }
  std::string access_path() const { return path_ + "/access.json"; }
  // What a living master says of its progress, for those who may not read the database meanwhile.
  std::string status_path() const { return path_ + "/status.json"; }
  // How the campaign uses Slurm; only when it was submitted.
  std::string slurm_path() const { return path_ + "/slurm.toml"; }
  // The searches of a sweep; only when there are several.
  std::string searches_path() const { return path_ + "/searches.json"; }
  // Secret keys, 0600; only when the master is reachable from other machines.
  std::string key_path() const { return path_ + "/master.key"; }
  // Which copy of the campaign this is (campaign_origin.h).
  std::string origin_path() const { return path_ + "/origin.json"; }
  // `gauntlet stop` was here; the master removes it.
  std::string stop_path() const { return path_ + "/stop"; }
  // Libraries of plug-ins (campaign_plugins.h).
  std::string plugins_path() const { return path_ + "/plugins"; }
  std::string log_path() const { return path_ + "/log"; }

  // Counts one more start of a master, durably, and returns its number (1, 2, ... 2^32 - 1). Only under the
  // campaign's lock. kCorrupt when the file holds something else.
  Result<std::uint64_t> StartEpoch();
  // Whether the master number `mine` is still the newest: kInUse when not, kNotFound when the file is gone.
  // Opens and reads one small file; a process that may open no more files only looks whether it is still the
  // one that StartEpoch has written.
  Status CheckEpoch(std::uint64_t mine) const;
  // Writes the number again, for the master that has it, when somebody has deleted the file.
  Status RestoreEpoch(std::uint64_t mine) const;

 private:
  explicit CampaignDirectory(std::string path) : path_(std::move(path)) {}

  std::string path_;                       // without a slash at its end
  std::optional<FileVersion> epoch_file_;  // as StartEpoch left it
};

// 128 random bits as 32 hex digits.
std::string NewCampaignId();

}  // namespace gauntlet
