#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/output/archive_table.h"
#include "cli/output/confirmation_table.h"
#include "cli/output/summary.h"
#include "master/campaign/verdict_text.h"
#include "master/session/reproduction_bundle.h"
#include "proto/run_failure.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostGenerations = 12;  // rows of the table
constexpr std::size_t kMostMembers = 10;
constexpr std::size_t kNoteWidth = 100;

// "12 of 60 runs (20.0 %)"
std::string RunsText(std::uint64_t counted, std::uint64_t runs) {
  const double share = static_cast<double>(counted) / static_cast<double>(runs);
  return fmt::format("{} of {} runs ({})", FormatCount(counted), FormatCount(runs),
                     std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share));
}

std::string Overview(const CampaignSummary& summary) {
  const SearchRow* search = FindSearch(summary.search);
  Table table({"", ""});
  if (summary.progress.generations > 1) {
    table.AddRow(
        {"generations", fmt::format("{} of {}", summary.progress.generation, summary.progress.generations)});
  }
  std::string runs = FormatCount(summary.runs_done);
  if (summary.runs_failed > 0) {
    runs += fmt::format(", {} of them without a result (crashed, hung, refused)",
                        FormatCount(summary.runs_failed));
  }
  table.AddRow({"runs", runs});
  table.AddRow({"test cases", fmt::format("{} different", FormatCount(summary.distinct_individuals))});
  table.AddRow(
      {"fitness", fmt::format("best {}   mean {}   worst {}   (of the {}; lower = tougher)",
                              FormatFitness(summary.best_fitness), FormatFitness(summary.mean_fitness),
                              FormatFitness(summary.worst_fitness),
                              NameOf(search == nullptr ? Individuals::kCases : search->individuals))});
  if (!summary.failing.empty()) {
    table.AddRow({"failing",
                  fmt::format("{}: {}", RunsText(summary.failing_runs, summary.runs_done), summary.failing)});
  }
  table.AddRow({"total failures", RunsText(summary.total_failures, summary.runs_done)});
  if (summary.total_failures > 0 && !summary.failure_types.empty()) {
    const auto seen =
        std::ranges::count_if(summary.failure_types, [](const auto& one) { return one.runs > 0; });
    std::string text = fmt::format("{} of {}", seen, summary.failure_types.size());
    if (const std::uint64_t untyped = summary.untyped_failures; untyped > 0) {
      text += fmt::format("; {} {} {}", FormatCount(untyped), untyped == 1 ? "failure" : "failures",
                          summary.untyped);
    }
    table.AddRow({"failure types", text});
  }
  table.AddRow({"state hash", summary.state_hash});
  return table.ToText();
}

// The failure types that occurred, the most frequent first.
std::string FailuresByType(const CampaignSummary& summary) {
  std::vector<FailureCount> failures = summary.failure_types;
  std::erase_if(failures, [](const FailureCount& one) { return one.runs == 0; });
  if (failures.empty()) return {};
  std::ranges::stable_sort(failures, std::greater(), &FailureCount::runs);
  Table table({">runs", ">type", "total failure"});
  for (const FailureCount& one : failures) {
    table.AddRow({FormatCount(one.runs), fmt::format("{}", one.type), one.name});
  }
  if (summary.untyped_failures > 0) {
    table.AddRow({FormatCount(summary.untyped_failures), "-", summary.untyped});
  }
  const std::string note =
      summary.failure_note.empty() ? "" : fmt::format("  {}\n", Wrapped(summary.failure_note, kNoteWidth, 2));
  return "\n" + table.ToText() + note;
}

// "6 of 8 refused: no-room-to-spawn: ...", the most frequent first.
std::string RunsWithoutAResult(const CampaignSummary& summary, const std::string& directory) {
  if (summary.runs_without_result.empty()) return {};
  constexpr std::size_t kMostGroups = 8;
  const auto& groups = summary.runs_without_result;
  std::string text = "\nRuns without a result\n";
  for (std::size_t i = 0; i < std::min(kMostGroups, groups.size()); ++i) {
    text += fmt::format("  {} of {} {}: {}\n", FormatCount(groups[i].runs), FormatCount(summary.runs_done),
                        NameOf(groups[i].verdict), Printable(proto::Explained(groups[i].message)));
    if (LeavesBundle(groups[i].verdict))
      text += fmt::format(
          "    to see {} again: {}\n", groups[i].runs == 1 ? "it" : "the first",
          PastedPath(fmt::format("{}/{}/README.txt", directory, BundleName(groups[i].first_run))));
  }
  if (groups.size() > kMostGroups)
    text += fmt::format("  and {} more reasons; see show --json\n", groups.size() - kMostGroups);
  return text;
}

std::string Generations(const CampaignSummary& summary) {
  if (summary.generations.size() < 2) return {};
  Table table({">generation", ">runs", ">best", ">mean", ">worst", ">total failures"});
  // The first, the last and generations at even distances between them.
  const std::size_t gaps = summary.generations.size() - 1;
  const std::size_t shown = std::min(gaps, kMostGenerations - 1);
  for (std::size_t i = 0; i <= shown; ++i) {
    const GenerationSummary& generation = summary.generations[(i * gaps + shown / 2) / shown];
    const auto fitness = [&](double value) { return generation.completed > 0 ? FormatFitness(value) : "-"; };
    table.AddRow({fmt::format("{}", generation.generation), FormatCount(generation.runs),
                  fitness(generation.best), fitness(generation.mean), fitness(generation.worst),
                  FormatCount(generation.total_failures)});
  }
  return "\n" + table.ToText();
}

std::vector<const PopulationMember*> Toughest(const CampaignSummary& summary) {
  std::vector<const PopulationMember*> members;
  for (const PopulationMember& member : summary.population) {
    if (std::isfinite(member.fitness) && !member.runs.empty()) members.push_back(&member);
  }
  std::ranges::stable_sort(members, {}, &PopulationMember::fitness);
  return members;
}

std::string Members(const CampaignSummary& summary) {
  const std::vector<const PopulationMember*> members = Toughest(summary);
  if (members.empty()) return {};
  const bool named = std::ranges::any_of(members, [](const auto* one) { return !one->name.empty(); });
  Table table({">test case", ">fitness", ">obstacles", ">born in generation", ">runs", ">latest run",
               named ? "file" : ""});
  for (std::size_t i = 0; i < std::min(kMostMembers, members.size()); ++i) {
    const PopulationMember& member = *members[i];
    table.AddRow({fmt::format("{}", member.id), FormatFitness(member.fitness),
                  fmt::format("{}", member.genome.size()), fmt::format("{}", member.birth_generation),
                  FormatCount(member.runs.size()), fmt::format("{}", member.runs.back()),
                  Printable(member.name)});
  }
  std::string text = members.size() > kMostMembers
                         ? fmt::format("\nThe toughest {} of {} test cases\n", kMostMembers, members.size())
                         : "\nThe test cases, toughest first\n";
  return text + table.ToText();
}

// What to type next; `first`: rows with what is most worth it.
std::string Hints(const HintContext& context, bool finished, const std::vector<std::vector<Cell>>& first) {
  const std::string directory = PastedPath(context.directory);
  Table table({"", ""});
  if (!finished)
    table.AddRow({fmt::format("{} resume {}", context.program, directory), "# go on where it stopped"});
  for (const std::vector<Cell>& row : first) table.AddRow(row);
  table.AddRow({fmt::format("{} show {} --json", context.program, directory), "# everything, for scripts"});
  return "\nNext commands to try\n" + table.ToText();
}

// "gauntlet replay DIR 812 --svg case-7.svg"
std::string ReplayHint(const HintContext& context, RunId run, std::string_view what, std::uint64_t number) {
  return fmt::format("{} replay {} {} --svg {}-{}.svg", context.program, PastedPath(context.directory), run,
                     what, number);
}

// "" when every repeated run ended as before.
std::string NotReproducible(const CampaignSummary& summary) {
  if (summary.nondeterministic == 0) return "";
  return fmt::format(
      "WARNING: the same run gave different results. The campaign is not reproducible: do not trust its "
      "figures.\n{}\n",
      summary.plugin_controllers.empty() ? "" : WhyNotReproducible(summary) + "\n");
}

// What a broken machine alone may have made up; "" when there is nothing of the kind.
std::string LoneVerdicts(const CampaignSummary& summary) {
  if (summary.lone_verdicts == 0) return "";
  return fmt::format(
      "{} runs without a result stand on the word of one worker each: there was no other to ask. `replay` "
      "shows "
      "whether they end so elsewhere.\n\n",
      FormatCount(summary.lone_verdicts));
}

std::string SweepText(const CampaignSummary& summary, const CampaignAnswers& answers,
                      const HintContext& context) {
  const auto finished = std::ranges::count(summary.searches, true, &CampaignSummary::finished);
  std::string text = fmt::format("{}: {} searches, {} finished, {} runs, {} of them total failures\n\n",
                                 Printable(summary.experiment), summary.searches.size(), finished,
                                 FormatCount(summary.runs_done), FormatCount(summary.total_failures));
  text += NotReproducible(summary);
  text += LoneVerdicts(summary);
  Table table(
      {">search", "settings", ">generation", ">runs", ">best", ">mean", ">total failures", "state hash"});
  constexpr std::size_t kShownDigits = 16;
  for (std::size_t i = 0; i < summary.searches.size(); ++i) {
    const CampaignSummary& one = summary.searches[i];
    table.AddRow({fmt::format("{}", i + 1), Printable(one.settings),
                  fmt::format("{}/{}", one.progress.generation, one.progress.generations),
                  FormatCount(one.runs_done), FormatFitness(one.best_fitness),
                  FormatFitness(one.mean_fitness), FormatCount(one.total_failures),
                  one.state_hash.substr(0, kShownDigits)});
  }
  const std::string directory = PastedPath(context.directory);
  return text + table.ToText() + DistinctFailuresText(answers, context.program) +
         Hints(context, summary.finished,
               {{fmt::format("{0} compare {1}:search:1 {1}:search:{2}", context.program, directory,
                             summary.searches.size()),
                 "# is one search's population tougher than another's?"}});
}

}  // namespace

std::string WhyNotReproducible(const CampaignSummary& summary) {
  return fmt::format(
      "The controller '{}' of the plug-in is not reproducible: it uses the time, addresses, or chance that "
      "the run does not seed. Or else a worker is broken: log/master.log names those that disagree.",
      Printable(fmt::format("{}", fmt::join(summary.plugin_controllers, "' or '"))));
}

std::string SummaryText(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const HintContext& context) {
  if (!summary.searches.empty()) return SweepText(summary, answers, context);
  const SearchRow* search = FindSearch(summary.search);
  std::string text = fmt::format("{}: {}, seed {}, {}\n\n", Printable(summary.experiment),
                                 search == nullptr ? summary.search : std::string(search->title),
                                 summary.seed, summary.finished ? "finished" : "not finished");
  text += NotReproducible(summary);
  text += LoneVerdicts(summary);
  if (summary.runs_done > 0 && summary.runs_failed == summary.runs_done) {
    text += fmt::format("NO RUN GAVE A RESULT: of {} runs none could be simulated to its end.\n\n",
                        FormatCount(summary.runs_done));
  }
  text += Overview(summary) + FailuresByType(summary) + RunsWithoutAResult(summary, context.directory) +
          Generations(summary) +
          (summary.archive.axes.empty() ? Members(summary) : ArchiveText(summary, context)) +
          DistinctFailuresText(answers, context.program);

  std::vector<std::vector<Cell>> first;
  if (const auto members = Toughest(summary); !members.empty()) {
    const PopulationMember& best = *members.front();
    first.push_back(
        {ReplayHint(context, best.runs.back(), "case", best.id), "# see what happened in the toughest case"});
  }
  const std::uint64_t failing = summary.failing.empty() ? summary.total_failures : summary.failing_runs;
  if (failing > 0 && answers.confirmations.empty()) {
    first.push_back(
        {fmt::format("{} confirm {} --all-failing", context.program, PastedPath(context.directory)),
         "# how many different failures are these?"});
  }
  return text + Hints(context, summary.finished, first);
}

}  // namespace gauntlet
