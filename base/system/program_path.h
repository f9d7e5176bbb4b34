// Where the programs of this installation are. They stand beside each other.
#pragma once

#include <string>

namespace gauntlet {

// $GAUNTLET_PROGRAM, which a bundle's wrapper sets, else this executable; "gauntlet" when it cannot be known.
std::string MasterProgramPath();
// $GAUNTLET_WORKER, else gauntlet-worker beside this executable.
std::string WorkerProgramPath();

}  // namespace gauntlet
