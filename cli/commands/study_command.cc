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
      "study", "many searches, re-simulations and comparisons, such as the whole thesis", RunStudy);
  command.add_option("STUDY", options.study, "a shipped study, or a TOML file")->required();
  AddStudyStartOptions(command, options.start);
  std::string shipped;
  for (const std::string& name : ShippedStudies()) shipped += (shipped.empty() ? "" : ", ") + name;
  command.footer(fmt::format(R"(Shipped studies: {}.

A study file lists parts (evolutions, random cases, and cases simulated again with fresh seeds or another
controller), what is computed from them, and the published figures beside it. All searches share the
workers, so no core waits at the end of a generation; then follow all re-simulations. They are ordinary
campaigns, DIR/searches and DIR/evaluations: 'show', 'replay' and 'compare' work on them. Killed or stopped
at any moment, it goes on with the same command, or with 'gauntlet resume DIR', and ends the same.

Examples:
  gauntlet study thesis-flocking --dir campaigns/flocking-study
  gauntlet study thesis --dry-run
  gauntlet study thesis --dir campaigns/thesis --markdown thesis.md --json > thesis.json)",
                             shipped));
}

}  // namespace gauntlet
