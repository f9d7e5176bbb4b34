#include "base/system/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace gauntlet {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  std::error_code failed;
  std::string made = fs::temp_directory_path(failed) / ("gauntlet-" + purpose + "-XXXXXX");
  if (!failed && mkdtemp(made.data()) != nullptr) path_ = fs::canonical(made, failed);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace gauntlet
