#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/tables/section.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/output/summary.h"
#include "master/campaign/verdict_text.h"
#include "master/session/reproduction_bundle.h"
#include "proto/run_failure.h"
#include "proto/run_text.h"
#include "report/tables/conditions.h"
#include "report/tables/distinct_failures.h"
#include "report/tables/next_commands.h"
#include "report/tables/summary_tables.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostGenerations = 12;  // rows of the table
constexpr std::size_t kMostMembers = 10;
constexpr std::size_t kMostFailures = 20;  // that are listed
constexpr std::size_t kShownSearches = 30;
constexpr std::size_t kNoteWidth = 100;

// "6 of 8 refused: no-room-to-spawn: ...", the most frequent first.
std::string RunsWithoutAResult(const SearchSummary& summary, const std::string& directory) {
  if (summary.runs_without_result.empty()) return {};
  constexpr std::size_t kMostGroups = 8;
  const auto& groups = summary.runs_without_result;
  std::string text = "\nRuns without a result\n";
  for (std::size_t i = 0; i < std::min(kMostGroups, groups.size()); ++i) {
    text += fmt::format("  {} of {} {}: {}\n", FormatCount(groups[i].runs), FormatCount(summary.runs_done),
                        NameOf(groups[i].verdict), Printable(proto::Explained(groups[i].message)));
    if (groups[i].verdict == sim::Verdict::kKilled)
      text +=
          "    a memory killer or an operator of the machine may have done it: elsewhere it may end "
          "otherwise\n";
    const std::string words = LastWords(directory, groups[i].first_run);
    if (!words.empty())
      text += fmt::format("    {} printed last: {}\n", groups[i].runs == 1 ? "it" : "the first",
                          Printable(words));
    if (LeavesBundle(groups[i].verdict))
      text += fmt::format(
          "    to see {} again: {}\n", groups[i].runs == 1 ? "it" : "the first",
          PastedPath(fmt::format("{}/{}/README.txt", directory, BundleName(groups[i].first_run))));
  }
  if (groups.size() > kMostGroups)
    text += fmt::format("  and {} more reasons; see show --json\n", groups.size() - kMostGroups);
  return text;
}

std::string Generations(const SearchSummary& summary) {
  if (summary.generations.size() < 2) return {};
  return "\n" + GenerationTable(summary).Thinned(kMostGenerations).ToText();
}

std::string Members(const SearchSummary& summary) {
  std::vector<const PopulationMember*> members;
  for (const PopulationMember& member : summary.population) {
    if (std::isfinite(member.fitness) && !member.runs.empty()) members.push_back(&member);
  }
  if (members.empty()) return {};
  const std::size_t count = members.size();
  const bool named = std::ranges::any_of(members, [](const auto* one) { return !one->name.empty(); });
  // They stand in one list, so that an address tells which of equal ones comes first.
  const auto order = [](const auto* one) { return std::pair(one->fitness, one); };
  std::vector<const PopulationMember*> first(std::min(kMostMembers, count));
  std::ranges::partial_sort_copy(members, first, {}, order, order);
  const auto as_tough = std::ranges::count(members, first.front()->fitness, &PopulationMember::fitness);
  const std::string title =
      count <= kMostMembers ? "The test cases, toughest first"
      : static_cast<std::size_t>(as_tough) > kMostMembers
          ? fmt::format("{} of the {} toughest of {} test cases", kMostMembers, as_tough, count)
          : fmt::format("The toughest {} of {} test cases", kMostMembers, count);
  return fmt::format("\n{}\n{}", title, PopulationTable(first, named).ToText());
}

// What was tried in vain.
std::string NothingFound(const SearchSummary& summary) {
  std::uint64_t admitted = 0;
  for (const auto& [name, value] : summary.statistics) {
    if (name.ends_with("_elites")) admitted += static_cast<std::uint64_t>(value);
  }
  std::string text = fmt::format(
      "\nNothing fails reliably: {} of {} test cases failed in {}{}. {} of {} runs failed.",
      admitted == 0 ? "none" : FormatCount(admitted), FormatCount(summary.distinct_individuals),
      summary.archive.toughest ? "half of its runs" : "3 of 3 or 4 of 5 runs, in the same cell",
      admitted == 0 ? ""
                    : ", which luck may do here: they are expected to fail in less than 60 % of further ones",
      FormatCount(summary.failing_runs), FormatCount(summary.runs_done));
  std::string separator = " The runs went to";
  const auto tried = [&](const char* statistic, const char* what) {
    const auto found =
        std::ranges::find(summary.statistics, statistic, &std::pair<std::string, double>::first);
    if (found == summary.statistics.end() || found->second == 0.0) return;
    text +=
        fmt::format("{} {} ({})", separator, what, FormatCount(static_cast<std::uint64_t>(found->second)));
    separator = ",";
  };
  tried("random_runs", "random cases");
  tried("alone_runs", "single obstacles in the way");
  tried("nearest_runs", "parts of cases that had failed once");
  return text +
         ".\nMore runs (`gauntlet resume DIR --set search.runs=N`), more obstacles (genome.genes) or fewer "
         "cells (search.cells) may find something.\n";
}

// What the archive of a search for many different failures holds.
std::string ArchiveText(const SearchSummary& summary, const HintContext& context) {
  const ArchiveView& archive = summary.archive;
  if (archive.failures.empty()) return NothingFound(summary);
  std::string text;
  if (archive.axes.size() == 2) {
    text =
        fmt::format("\nThe fewest obstacles that break the swarm, by {} (to the right) and {} (upwards)\n{}",
                    archive.axes[0].metric, archive.axes[1].metric, ArchiveMap(summary).ToText());
  }
  const std::string replay = fmt::format("{} replay {}", context.program, PastedPath(context.directory));
  return text +
         fmt::format("\n{} of {} cells hold a failure; the {} of each, fewest obstacles first\n{}",
                     archive.failures.size(), CellsOf(archive), archive.toughest ? "toughest" : "smallest",
                     ArchiveTable(summary, replay).ToText()) +
         "  The runs that failed took part in choosing these cases; `gauntlet confirm` simulates them "
         "anew.\n";
}

// What to type next; `first`: what is most worth it.
std::string Hints(const HintContext& context, const CampaignSummary& summary,
                  const std::vector<NextCommand>& first) {
  const std::string directory = PastedPath(context.directory);
  Section section{.title = "Next commands to try"};
  if (!summary.finished)
    section.commands.push_back(
        {GoOnCommand(summary, context.program, context.directory), "go on where it stopped"});
  section.commands.insert(section.commands.end(), first.begin(), first.end());
  section.commands.push_back(
      {fmt::format("{} show {} --json", context.program, directory), "everything, for scripts"});
  return ToText(section);
}

std::string WarningsText(const CampaignSummary& summary) {
  std::string text;
  for (const std::string& warning : WarningsOf(summary)) text += Printable(warning) + "\n";
  return text.empty() ? "" : text + "\n";
}

// "run 8, minimised to 2 obstacles, fails in 24 of 30 runs".
std::string DescribeSmallest(const SmallestLayout& smallest) {
  const std::size_t obstacles = smallest.document.test_case.obstacles.size();
  const proto::CaseFailures& verified = smallest.document.lineage->verified;
  return fmt::format("run {}, minimised to {} obstacle{}, fails in {} of {} runs",
                     proto::RunText(smallest.run), obstacles, obstacles == 1 ? "" : "s", verified.failures,
                     verified.runs);
}

// What is to be read before all else; "" = nothing.
std::string BaselineWarning(const SearchSummary& search, const CampaignAnswers& answers,
                            const HintContext& context) {
  if (!HasBaseline(search.search) || !Matters(answers.baselines)) return "";
  return InWords(answers.baselines, context.program, context.directory) + "\n\n";
}

// How the swarm does without a search: what its failures are held against.
void AddBaseline(const SearchSummary& search, const CampaignAnswers& answers, const HintContext& context,
                 Table& facts) {
  if (!HasBaseline(search.search)) return;
  const auto failed = [](std::uint64_t failures, std::uint64_t runs) {
    return fmt::format("{} of {} runs fail", FormatCount(failures), FormatCount(runs));
  };
  const SearchRow* row = FindSearch(search.search);
  if (row != nullptr && row->Breeds() && search.generations.size() > 1) {
    const GenerationSummary& first = search.generations.front();
    facts.AddRow({"random cases", failed(first.total_failures, first.runs) + " (generation 1)"});
  }
  if (answers.baselines.empty()) {
    facts.AddRow({"no obstacles", fmt::format("not known: {} baseline {} looks", context.program,
                                              PastedPath(context.directory))});
    return;
  }
  const FailureTally& tally = answers.baselines.front().tally;
  facts.AddRow({"no obstacles", failed(static_cast<std::uint64_t>(tally.failures),
                                       static_cast<std::uint64_t>(tally.runs()))});
}

// "" when there is nothing to tell.
std::string DistinctFailuresText(const CampaignAnswers& answers, const std::string& program) {
  std::string text;
  for (const Section& one : TellDistinctFailures(answers, kMostFailures, program)) text += ToText(one);
  std::size_t told = 0;
  for (const SmallestLayout& one : answers.smallest_layouts) {
    if (one.Smaller() && told++ < kMostFailures)
      text += fmt::format("  {}: {}\n", DescribeSmallest(one), PastedPath(one.file));
  }
  return text;
}

std::string SweepText(const CampaignSummary& summary, const CampaignAnswers& answers,
                      const HintContext& context) {
  const auto finished = std::ranges::count(summary.searches, true, &SearchSummary::finished);
  const ObservedReproducibility& seen = summary.reproducibility;
  const std::vector<Condition> conditions = ConditionsOf(summary);
  const std::size_t searches = summary.searches.size();
  std::string text = fmt::format("{}: {} searches, {} finished, {} runs\n\n", Printable(summary.experiment),
                                 searches, finished, FormatCount(summary.runs_done)) +
                     WarningsText(summary) + BaselineWarning(summary.searches.front(), answers, context) +
                     (seen.observed() ? fmt::format("reproducible: {}\n\n", Printable(InWords(seen))) : "");
  if (conditions.size() > 1)
    text += "How often it fails under each condition\n" +
            ConditionsTable(conditions).First(kShownSearches).ToText() + "\nThe searches\n";
  text += SearchesTable(summary, kShownSearches).ToText();
  if (searches > kShownSearches)
    text += fmt::format("  and {} more; --json tells all\n", searches - kShownSearches);
  text += DistinctFailuresText(answers, context.program);
  return text + Hints(context, summary, NextCommandsOf(summary, answers, context.program, context.directory));
}

}  // namespace

std::string SummaryText(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const HintContext& context) {
  const SearchSummary* only = summary.OnlySearch();
  if (only == nullptr) return SweepText(summary, answers, context);
  const SearchRow* search = FindSearch(only->search);
  std::string text = fmt::format("{}: {}, seed {}, {}\n\n", Printable(summary.experiment),
                                 search == nullptr ? only->search : std::string(search->title), only->seed,
                                 summary.finished ? "finished" : "not finished");
  text += WarningsText(summary) + BaselineWarning(*only, answers, context);
  if (summary.runs_done > 0 && summary.runs_failed == summary.runs_done) {
    text += fmt::format("NO RUN GAVE A RESULT: of {} runs none could be simulated to its end.\n\n",
                        FormatCount(summary.runs_done));
  }
  Table facts({"", ""});
  AddTally(*only, only, facts);
  AddReproducibility(summary, facts);
  AddBaseline(*only, answers, context, facts);
  return text + facts.ToText() + RunsWithoutAResult(*only, context.directory) + Generations(*only) +
         (only->archive.axes.empty() ? Members(*only) : ArchiveText(*only, context)) +
         DistinctFailuresText(answers, context.program) +
         Hints(context, summary, NextCommandsOf(summary, answers, context.program, context.directory));
}

std::string TypesText(const CampaignSummary& summary) {
  std::string text;
  for (const SearchSummary& one : summary.searches) {
    if (!one.settings.empty()) text += fmt::format("{}\n", Printable(one.settings));
    text += one.types.types.empty() ? "  Its scenario tells no types of failures apart.\n"
                                    : FailureTypeTable(one).ToText();
    if (one.untyped_failures > 0) {
      text +=
          fmt::format("  and {} total failures {}\n", FormatCount(one.untyped_failures), one.types.untyped);
    }
    if (!one.types.types.empty() && !one.types.note.empty())
      text += fmt::format("  {}\n", Wrapped(one.types.note, kNoteWidth, 2));
  }
  return text;
}

}  // namespace gauntlet
