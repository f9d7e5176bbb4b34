// The rows of a plug-in as data: what a worker tells of them.
#pragma once

#include "controllers/behaviour.h"
#include "proto/plugin_description.h"

namespace gauntlet::worker {

proto::DescribedController DescriptionOf(const controllers::ControllerInfo& row);
proto::DescribedScenario DescriptionOf(const controllers::ScenarioInfo& row);

}  // namespace gauntlet::worker
