// The files of a campaign that its living master relies on.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/regular_file.h"
#include "master/directory/campaign_directory.h"

namespace gauntlet {

// Some must stay what they are: what is written into a file that somebody has deleted or replaced is lost,
// and no write says so. They are known by device and inode, which a move keeps: the old place of a directory
// that was moved is empty. Others, which say what the campaign is to do, are written again when somebody
// deletes them. Thread-safe.
class OwnedFiles {
 public:
  // Remembers the second sort as they are, those that do not exist yet once they do, and changes by their
  // owner whenever they are checked.
  explicit OwnedFiles(const CampaignDirectory& directory);

  // The first sort are the directory, the database, what SQLite keeps beside it, and the lock, as far as they
  // exist now. To be called while the database is open. Errors: kIo.
  Status NoteOpened();

  // A few lstat(2). kNotFound says what was deleted or replaced, what is lost, and what to do; kIo when it
  // cannot be looked at; kNoSpace, kIo when a file cannot be written again.
  Status Check();

 private:
  struct Opened {
    std::string path;
    std::string name;  // for messages
    std::string loss;  // what it means that the file is gone, a sentence without its full stop
    FileId id = {};
  };
  struct Kept {
    std::string path;
    std::string text = "";
    std::optional<FileVersion> seen = {};  // that holds the text
  };
  static Status Keep(Kept& file);

  const CampaignDirectory directory_;
  std::mutex mutex_;  // guards the two below
  std::vector<Opened> opened_;
  std::vector<Kept> kept_;
};

}  // namespace gauntlet
