// Where the programs of this installation are. They stand beside each other.
#pragma once

#include <string>

namespace gauntlet {

// $GAUNTLET_PROGRAM, which the launcher of a release sets, else this executable; "gauntlet" when it cannot be
// known.
std::string MasterProgramPath();
// $GAUNTLET_WORKER, else gauntlet-worker beside MasterProgramPath().
std::string WorkerProgramPath();

}  // namespace gauntlet
