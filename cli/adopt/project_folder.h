// The folder of somebody's project, and the folders in which its runs find it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// The folder from which all these libraries, as an .argos file names them, are found, and most of what else
// may be files: the current one, that of the file or one above it. Error: which library is nowhere, and where
// it was looked for.
Result<std::string> FindProjectFolder(const std::string& argos_file,
                                      const std::vector<std::string>& libraries,
                                      const std::vector<std::string>& paths);

// What tells versions of a file apart.
struct FileStamp {
  std::uint64_t size = 0;
  std::int64_t written = 0;  // ns
  bool operator==(const FileStamp&) const = default;
};
// The regular files in a folder and below it, by their path in it.
std::map<std::string, FileStamp> FilesIn(const std::string& folder);

// Copies the project, without what version control keeps, links staying links. Error: also when it is larger
// than a gigabyte.
Status CopyProject(const std::string& project, const std::string& folder);
// What the folder of a run has of the project as it is now: small files are copies, all other entries links.
// Folders with few entries, and those in which a run writes or loads something, are the run's own.
struct RunFolderPlan {
  std::string project;                           // its absolute path
  std::string own;                               // the folder of what is ours in a run's folder
  std::map<std::string, std::string> libraries;  // by path in the project: the name in `own`/lib
  std::vector<std::string> written;              // paths in the project's folder that a run writes or makes
};
// A script for /bin/sh that makes the folder and starts ARGoS with the file that it is given.
std::string RunScript(const RunFolderPlan& plan);

}  // namespace gauntlet
