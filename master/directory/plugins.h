// The plug-ins that a master was told of. It loads none itself: it asks gauntlet-worker what a library
// brings, and knows names, parameters and ranges from then on (controllers/registry.h).
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet::master {

// Makes the library's controllers known; its SHA-256. Error: it cannot be read, or why gauntlet-worker
// refuses it; a built-in controller has the name of one.
Result<std::string> AddPluginFile(const std::string& file);

// The same of several files, in their order. Error: also that two of them bring controllers of one name.
Result<std::vector<std::string>> AddPluginFiles(const std::vector<std::string>& files);

// The same of a library that was described before: `description` as proto/plugin_description.h writes it,
// which is called `place` in errors.
Status AddDescribedPlugin(const std::string& hash, const std::string& file, const std::string& description,
                          const std::string& place);

}  // namespace gauntlet::master
