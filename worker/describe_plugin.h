// What a plug-in brings, asked of the library itself under limits.
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "worker/plugin_files.h"

namespace gauntlet::worker {

// The description of a library as JSON; worker/plugin_library.h has the real one.
using DescribePluginFunction = std::function<Result<std::string>(const PluginFile& file)>;

// Prints the description to stdout. The library is loaded in a process of its own, so whatever it does it
// ends there. The exit code: 0, or 2 after saying on stderr what is wrong with it.
int PrintDescription(const std::string& path, const DescribePluginFunction& describe);

}  // namespace gauntlet::worker
