// Whether what a plug-in brings is right.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/result.h"
#include "controllers/rows/plugin_rows.h"

namespace gauntlet::controllers {

// What is wrong with the data of a scenario: a name that is none or is given twice, a range that is none or
// that the default is not in, a metric, a failure type or the time limit that it names and does not have;
// kInvalidInput.
Status CheckScenario(const ScenarioInfo& scenario);
// The same of all rows; they are no plug-in without any.
Status CheckRows(const PluginRows& rows);

// Of what WriteRows has written; a JSON value. `place` is named in errors (kInvalidInput), which are also
// those of CheckRows.
Result<PluginRows> ReadRows(const nlohmann::json& json, const std::string& place);

}  // namespace gauntlet::controllers
