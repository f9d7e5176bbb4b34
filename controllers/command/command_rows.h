// What a command brings, as a plug-in's rows: its scenario with the metrics, its controller with the
// parameters.
#pragma once

#include "controllers/command/definition.h"
#include "controllers/rows/plugin_rows.h"

namespace gauntlet::controllers::command {

// Without functions.
PluginRows RowsOf(const Definition& definition);

}  // namespace gauntlet::controllers::command
