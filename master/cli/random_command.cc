// gauntlet random: the baseline of random test cases.
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/run_search.h"

namespace gauntlet::master {
namespace {

struct RandomOptions : SearchOptions {
  std::string cases;
};

ExitCode RunRandom(CommandContext& context, const RandomOptions& options) {
  std::vector<ExtraSet> extra = {{"random", "search.algorithm", "random"}};
  if (!options.cases.empty()) extra.push_back({"--cases", "search.cases", options.cases});
  return RunSearch(context, options, extra);
}

}  // namespace

void AddRandom(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("random", "random test cases: the baseline to hold an evolution against", RunRandom);
  AddExperimentOptions(command, options.experiment);
  AddRefusedSizeOptions(command, options.size);
  AddRunningOptions(command, options.running);
  command
      .add_option("--cases", options.cases, "how many test cases (default: the experiment's search.cases)")
      ->type_name("N");
  command.footer(
      R"(Generates valid random test cases by the experiment's rules and simulates each once (more often with
--set search.replicates=K). The population that 'show' reports are all cases.

Examples:
  gauntlet random flocking --cases 200
  gauntlet random flocking --cases 1000 --seed 7 --dir campaigns/baseline)");
}

}  // namespace gauntlet::master
