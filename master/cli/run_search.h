// What evolve and random have in common: a search on a pool of workers of this machine.
#pragma once

#include <vector>

#include "master/cli/command_context.h"
#include "master/cli/options.h"

namespace gauntlet::master {

struct SearchOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  RunningOptions running;
};

// Runs the experiment with `extra` settings. Refused: a search of given cases, and settings that the
// experiment's search does not read.
ExitCode RunSearch(CommandContext& context, const SearchOptions& options, const std::vector<ExtraSet>& extra);

}  // namespace gauntlet::master
