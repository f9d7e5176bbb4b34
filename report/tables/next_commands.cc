#include "report/tables/next_commands.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "base/shell_quoted.h"
#include "proto/run_text.h"
#include "report/tables/conditions.h"
#include "report/tables/summary_tables.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// The command up to the directory: "gauntlet confirm campaigns/first".
using Begin = std::function<std::string(const char* command)>;

// The toughest case of all searches, in its latest run; of an archive its smallest failure.
std::optional<NextCommand> ShowToughest(const CampaignSummary& summary, const Begin& begin) {
  const SearchSummary* only = summary.OnlySearch();
  if (only != nullptr && !only->archive.failures.empty()) {
    const PopulationMember& smallest = *SmallestFirst(*only).front();
    if (smallest.runs.empty()) return std::nullopt;
    return NextCommand{fmt::format("{} {} --svg case-{}.svg", begin("replay"),
                                   proto::RunText(smallest.runs.front()), smallest.id),
                       "see what happens in the smallest failure"};
  }
  const PopulationMember* best = nullptr;
  for (const SearchSummary& search : summary.searches) {
    for (const PopulationMember& member : search.population) {
      if (!std::isfinite(member.fitness) || member.runs.empty()) continue;
      if (best == nullptr || member.fitness < best->fitness) best = &member;
    }
  }
  if (best == nullptr) return std::nullopt;
  const RunId run = best->runs.back();
  return NextCommand{
      fmt::format("{} {} --svg {}.svg", begin("replay"), proto::RunText(run),
                  only != nullptr ? fmt::format("case-{}", best->id) : proto::RunFileName(run)),
      "see what happened in the toughest case"};
}

}  // namespace

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
  if (row != nullptr && row->varies_settings)
    commands.push_back({begin(std::string(row->command).c_str()), "what it has found"});
  const Confirmation* toughest = ToughestOf(answers.confirmations);
  if (const auto shown = ShowToughest(summary, begin); shown && toughest == nullptr)
    commands.push_back(*shown);
  if (summary.failing_runs > 0 && answers.confirmations.empty())
    commands.push_back(
        {ConfirmCommand(summary, program, directory), "how many different failures are these?"});
  if (toughest != nullptr &&
      std::ranges::count(answers.smallest_layouts, toughest->run, &SmallestLayout::run) == 0) {
    const std::string run = proto::RunText(toughest->run);
    commands.push_back({fmt::format("{} {}", begin("minimise"), run),
                        "which of its obstacles does the toughest case take?"});
    commands.push_back({fmt::format("{} {}", begin("blame"), run), "how much does each of them do?"});
  }
  if (const std::vector<Condition> conditions = ConditionsOf(summary); conditions.size() > 1) {
    const std::string place = PastedPath(directory);
    commands.push_back(
        {fmt::format("{0} compare {1}:search:{2} {1}:search:{3}", program, place,
                     conditions.front().searches.front() + 1, conditions.back().searches.front() + 1),
         "do the first and the last setting differ?"});
  }
  return commands;
}

}  // namespace gauntlet
