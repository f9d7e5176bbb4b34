// Files that commands write where the user says.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/atomic_file.h"

namespace gauntlet {

// Written piece by piece. A regular file has the whole content after Close, and before it, or without it,
// what it had; pipes and devices are written as they are. Errors: kIo, kNoSpace, naming the path; afterwards
// nothing may be called.
class OutputFile {
 public:
  // A path that the user names. Error: also kInvalidInput when it is a file of a campaign, a study or a
  // corpus, or any SQLite database, which are never overwritten, or a named pipe.
  static Result<OutputFile> Open(const std::string& path);
  Status Write(std::string_view bytes);
  Status Close();

 private:
  friend Status WriteOwnFile(const std::string& path, std::string_view content);

  static Result<OutputFile> Begin(const std::string& path);
  explicit OutputFile(std::string path) : path_(std::move(path)) {}
  Status Named(const Status& written) const;
  Status OfStream() const;

  std::string path_;
  std::optional<FileReplacement> file_;
  std::ofstream stream_;  // of what is no regular file
};

// The same of a path that the command chooses itself, such as a case of a corpus.
Status WriteOwnFile(const std::string& path, std::string_view content);
// The same of a path that the user names, and a content that is there.
Status WriteOutputFile(const std::string& path, std::string_view content);

// A directory of files. `write` gets the path of a directory to fill, and says how many files it has written;
// that directory takes the place of `path`, which must not exist or be empty, when all are there, and is
// removed after an error. `option` is for messages. Errors: kInvalidInput, kIo, kNoSpace, those of `write`.
Result<std::uint64_t> WriteOutputDirectory(
    const std::string& option, const std::string& path,
    const std::function<Result<std::uint64_t>(const std::string& draft)>& write);

}  // namespace gauntlet
