// The rows of what a plug-in brings, in a master: as gauntlet-worker describes them, without any code.
#pragma once

#include "controllers/registry.h"
#include "proto/plugin_description.h"

namespace gauntlet {

// The texts that rows refer to live as long as this process. Robots of a described controller do nothing: a
// master only counts them. A described scenario has neither `requirements` nor `create`
// (controllers/run_start.h answers for it).
controllers::ControllerInfo RowOf(proto::DescribedController described);
controllers::ScenarioInfo RowOf(proto::DescribedScenario described);

}  // namespace gauntlet
