// Whether the files of a campaign are still those that its master has opened.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/regular_file.h"
#include "master/directory/campaign_directory.h"

namespace gauntlet {

// What is written into a file that somebody has deleted or replaced is lost, and no write says so. Files are
// known by device and inode, which a move keeps: the old place of a directory that was moved is empty.
// Thread-safe.
class OpenedFiles {
 public:
  // The directory, the database, what SQLite keeps beside it, and the lock, as far as they exist now. To be
  // taken while the database is open. Errors: kIo.
  static Result<OpenedFiles> Of(const CampaignDirectory& directory);

  // A few lstat(2). kNotFound says what was deleted or replaced, what is lost, and what to do; kIo when it
  // cannot be looked at.
  Status Check() const;

 private:
  struct File {
    std::string path;
    std::string name;  // for messages
    std::string loss;  // what it means that the file is gone, a sentence without its full stop
    FileId id = {};
  };
  OpenedFiles() = default;

  std::vector<File> files_;
};

}  // namespace gauntlet
