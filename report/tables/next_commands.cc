#include "report/tables/next_commands.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "proto/run_text.h"
#include "report/tables/conditions.h"
#include "report/tables/summary_tables.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// The command up to the directory: "gauntlet confirm campaigns/first".
using Begin = std::function<std::string(const char* command)>;

std::optional<NextCommand> ShowToughest(const CampaignSummary& summary, const Begin& begin) {
  const std::optional<ToughestCase> toughest = ToughestCaseOf(summary);
  if (!toughest) return std::nullopt;
  const SearchSummary* only = summary.OnlySearch();
  const std::string file =
      only != nullptr ? fmt::format("case-{}", toughest->member->id) : proto::RunFileName(toughest->run);
  const bool smallest = only != nullptr && !only->archive.failures.empty();
  return NextCommand{
      fmt::format("{} {} --svg {}.svg", begin("replay"), proto::RunText(toughest->run), file),
      smallest ? "see what happens in the smallest failure"
      : toughest->as_tough > 1
          ? fmt::format("see what happened in one of the {} toughest cases", FormatCount(toughest->as_tough))
          : "see what happened in the toughest case"};
}

}  // namespace

std::string GoOnCommand(const CampaignSummary& summary, const std::string& program,
                        const std::string& directory) {
  const SearchRow* row = FindSearch(summary.searches.front().search);
  const bool streamed = row != nullptr && row->streamed;
  return streamed ? fmt::format("{} evaluate ... --stdin --dir {}", program, PastedPath(directory))
                  : fmt::format("{} resume {}", program, PastedPath(directory));
}

std::string ConfirmCommand(const CampaignSummary& summary, const std::string& program,
                           const std::string& directory) {
  const SearchSummary* only = summary.OnlySearch();
  const bool archive = only != nullptr && !only->archive.failures.empty();
  return fmt::format("{} confirm {} {} --replicates 20", program, PastedPath(directory),
                     archive ? "--elites" : "--all-failing");
}

std::vector<NextCommand> NextCommandsOf(const CampaignSummary& summary, const CampaignAnswers& answers,
                                        const std::string& program, const std::string& directory) {
  const Begin begin = [&](const char* command) {
    return fmt::format("{} {} {}", program, command, PastedPath(directory));
  };
  std::vector<NextCommand> commands;
  const SearchRow* row = FindSearch(summary.searches.front().search);
  const bool varies_settings = row != nullptr && row->varies_settings && !row->streamed;
  if (varies_settings) commands.push_back({begin(std::string(row->command).c_str()), "what it has found"});
  const Confirmation* toughest = ToughestOf(answers.confirmations);
  if (const auto shown = ShowToughest(summary, begin); shown && toughest == nullptr)
    commands.push_back(*shown);
  if (!varies_settings && summary.failing_runs > 0 && answers.confirmations.empty())
    commands.push_back(
        {ConfirmCommand(summary, program, directory), "how many different failures are these?"});
  if (toughest != nullptr &&
      std::ranges::count(answers.smallest_layouts, toughest->run, &SmallestLayout::run) == 0) {
    const std::string run = proto::RunText(toughest->run);
    commands.push_back({fmt::format("{} {}", begin("minimise"), run),
                        "which of its obstacles does the toughest case take?"});
    commands.push_back({fmt::format("{} {}", begin("blame"), run), "how much does each of them do?"});
  }
  const std::vector<Condition> conditions = ConditionsOf(summary);
  if (conditions.size() > 1 && conditions.size() == summary.searches.size()) {
    const std::string place = PastedPath(directory);
    commands.push_back(
        {fmt::format("{0} compare {1}:search:{2} {1}:search:{3}", program, place,
                     conditions.front().searches.front() + 1, conditions.back().searches.front() + 1),
         "do the first and the last condition differ?"});
  }
  return commands;
}

}  // namespace gauntlet
