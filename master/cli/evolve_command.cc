// gauntlet evolve: a search on a local pool of workers.
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/run_search.h"

namespace gauntlet::master {
namespace {

ExitCode RunEvolve(CommandContext& context, const SearchOptions& options) {
  return RunSearch(context, options, {});
}

}  // namespace

void AddEvolve(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("evolve", "evolve test cases in which the swarm fails", RunEvolve);
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddRunningOptions(command, options.running);
  command.footer(
      R"(Evolves test cases with the experiment's search on a local pool of workers, shows progress, and ends
with a table of the toughest cases. Ctrl-C stops cleanly (exit 3); 'gauntlet resume DIR' goes on.
Same experiment, settings and seed: same result, whatever the number of workers.

Examples:
  gauntlet evolve flocking
  gauntlet evolve flocking --generations 100 --workers 8 --dir campaigns/long
  gauntlet evolve flocking --seed random --set search.crossover=uniform --json > result.json
  gauntlet evolve my-experiment.toml --set controller_parameters.bird_speed=0.1)");
}

}  // namespace gauntlet::master
