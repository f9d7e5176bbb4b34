// What is asked of plug-ins without a run: the libraries answer themselves, under limits.
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "sim/run_spec.h"
#include "worker/plugin/plugin_files.h"

namespace gauntlet::worker {

// What a library brings, as JSON; worker/plugin/plugin_library.h has the real one, as of the next.
using DescribePluginFunction = std::function<Result<std::string>(const PluginFile& file)>;
// How a run begins whose plug-ins are loaded, as JSON.
using DescribeBeginningFunction = std::function<Result<std::string>(const sim::RunSpec& spec)>;

// Libraries are loaded in a process of its own, so whatever they do ends there. The exit code of both: 0, or
// 2 after saying on stderr what is wrong, with the library's name.

// Prints the description of a library to stdout.
int PrintDescription(const std::string& path, const DescribePluginFunction& describe);

// Prints how the run of a serialized RunSpec begins. `plugins` has the files that it needs.
int PrintBeginning(const std::string& spec, const PluginSettings& plugins,
                   const DescribeBeginningFunction& describe);

}  // namespace gauntlet::worker
