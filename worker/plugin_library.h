// A plug-in's library in this process: opened, judged, and its controllers made known to the registry. Only
// processes that are there for one run or one description do this: what a library does to its process stays.
#pragma once

#include <string>

#include "base/result.h"
#include "worker/plugin_files.h"

namespace gauntlet::worker {

// Loads the library and adds its controllers to the registry as those of the plug-in with its hash. Error: it
// is no library of this machine, no plug-in, one that was made for other headers or by another compiler (what
// differs), its rows are wrong, or a built-in controller has the name of one.
Status LoadPlugin(const PluginFile& file);

// What the library brings, as proto/plugin_description.h writes it. Error: as LoadPlugin.
Result<std::string> DescribePlugin(const PluginFile& file);

}  // namespace gauntlet::worker
