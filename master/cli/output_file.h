// Files that commands write where the user says.
#pragma once

#include <string>

#include "base/result.h"

namespace gauntlet::master {

// A regular file has the whole content or what it had before; pipes and devices are written as they are.
// Error: kIo, kNoSpace, naming the path.
Status WriteOutputFile(const std::string& path, const std::string& content);

}  // namespace gauntlet::master
