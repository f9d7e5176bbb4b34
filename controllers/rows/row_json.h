// A row of the registry as JSON: all that it says without code. `list --json` shows it, and a worker
// describes a plug-in by it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "controllers/behaviour.h"

namespace gauntlet::controllers {

// A number that JSON does not have is a text, "nan" or "inf".
nlohmann::ordered_json JsonOf(const ScenarioInfo& row);
nlohmann::ordered_json JsonOf(const ControllerInfo& row);

// Rows without their functions. A member that is missing has its default, one that is not known is passed
// over: who wrote it may be older or newer. Throw nlohmann::json::exception when it is no row.
ScenarioInfo ReadScenario(const nlohmann::json& json);
ControllerInfo ReadController(const nlohmann::json& json);

}  // namespace gauntlet::controllers
