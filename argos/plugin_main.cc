// What makes a plug-in of sources that were written for ARGoS, when no .argos file says anything of them.
#include "argos/plugin_rows.h"
#include "sdk/plugin.h"

namespace {

std::vector<gauntlet::controllers::ControllerInfo> Controllers() {
  return gauntlet::argos_form::ControllerRows({});
}

}  // namespace

GAUNTLET_PLUGIN(Controllers)
