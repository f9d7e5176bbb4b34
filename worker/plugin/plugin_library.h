// A plug-in's library in this process: opened, judged, and what it brings made known to the registry. Only
// processes that are there for one run or one description do this: what a library does to its process stays.
#pragma once

#include <string>

#include "base/result.h"
#include "sim/run_spec.h"
#include "worker/plugin/plugin_files.h"

namespace gauntlet::worker {

// Loads the library and adds its controllers and scenarios to the registry as those of the plug-in with its
// hash. Error: it is no library of this machine, no plug-in, one that was made for other headers or by
// another compiler (what differs), its rows are wrong, or what is built in has the name of one.
Status LoadPlugin(const PluginFile& file);

// What the library brings, as controllers/rows/plugin_rows.h writes it. Error: as LoadPlugin.
Result<std::string> DescribePlugin(const PluginFile& file);

// How a run begins whose plug-ins are loaded, as proto/run_beginning.h writes it. Error: why nothing can be
// said of it, or what is wrong with what the scenario says.
Result<std::string> DescribeBeginning(const sim::RunSpec& spec);

}  // namespace gauntlet::worker
