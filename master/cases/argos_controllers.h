// The controllers of an ARGoS3 experiment file, for plug-ins that are built from their sources.
#pragma once

#include <string>

#include "base/result.h"

namespace gauntlet::master {

// C++ source of a plug-in's table of controllers that holds every section of <controllers>: tags of devices,
// parameters and ids. `file_name` stands in messages. Error "FILE:LINE:COLUMN: ..." for malformed XML,
// another root than <argos-configuration>, and no <controllers> with at least one element.
Result<std::string> ArgosControllerTable(const std::string& text, const std::string& file_name);

}  // namespace gauntlet::master
