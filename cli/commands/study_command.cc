// gauntlet study: searches, re-simulations and comparisons that belong together, by one command.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/study_run.h"
#include "master/directory/plugins.h"

namespace gauntlet {
namespace {

struct StudyOptions {
  std::string study;
  StudyStartOptions start;
};

Result<ExitCode> RunStudy(CommandContext& context, const StudyOptions& options) {
  TRY(const std::vector<std::string> plugins, AddPluginFiles(options.start.plugins));
  TRY(const Study study, LoadStudy(options.study, {}, plugins));
  return StartStudy(context, study, options.start);
}

}  // namespace

void AddStudy(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "study", "run many searches, re-simulations and comparisons, such as the whole thesis", RunStudy);
  command.add_option("STUDY", options.study, "a shipped study or a TOML file")->required();
  AddStudyStartOptions(command, options.start);
  std::string shipped;
  for (const std::string& name : ShippedStudies()) shipped += (shipped.empty() ? "" : ", ") + name;
  command.footer(fmt::format(R"(Shipped studies: {}.

A study file lists parts, analyses and published figures. The parts are evolutions, random cases, and cases that
are simulated again with fresh seeds or another controller. The analyses are computed from the parts, and the
published figures are printed beside them. First all searches run and share the workers, so that no core waits
for the end of a generation; then all re-simulations run. Both are ordinary campaigns, DIR/searches and
DIR/evaluations, on which 'show', 'replay' and 'compare' work. A study that was stopped or killed continues with
the same command, or with 'gauntlet resume DIR', and its result is the same.

Examples:
  gauntlet study thesis-flocking --dir campaigns/flocking-study
  gauntlet study thesis --dry-run
  gauntlet study thesis --dir campaigns/thesis --markdown thesis.md --json > thesis.json)",
                             shipped));
}

}  // namespace gauntlet
