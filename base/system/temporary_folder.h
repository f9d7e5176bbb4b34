// A folder for one piece of work, among the temporary files.
#pragma once

#include <string>

namespace gauntlet {

// Is removed with the object, and all that it holds.
class TemporaryFolder {
 public:
  // `purpose` is a part of its name: "build".
  explicit TemporaryFolder(const std::string& purpose);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  // Absolute and without links; "": none could be made in $TMPDIR or /tmp.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace gauntlet
