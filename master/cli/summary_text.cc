#include "master/cli/summary_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "base/printable.h"
#include "base/shell_quoted.h"
#include "master/cli/table.h"
#include "master/report/verdict_text.h"
#include "master/search/search_table.h"
#include "master/session/reproduction_bundle.h"

namespace gauntlet::master {
namespace {

constexpr std::size_t kMostGenerations = 12;  // rows of the table
constexpr std::size_t kMostMembers = 10;

std::string Percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-"
                    : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string NameOfSearch(const CampaignSummary& summary) {
  const SearchRow* search = FindSearch(summary.search);
  return search == nullptr ? summary.search : std::string(search->title);
}

std::string Overview(const CampaignSummary& summary) {
  const SearchRow* search = FindSearch(summary.search);
  Table table({{"", Align::kLeft}, {"", Align::kLeft}});
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
      {"fitness",
       fmt::format("best {}   mean {}   worst {}   (of the {}; lower = tougher)",
                   FormatFitness(summary.best_fitness), FormatFitness(summary.mean_fitness),
                   FormatFitness(summary.worst_fitness), search == nullptr ? "cases" : search->members)});
  table.AddRow({"total failures", fmt::format("{} of {} runs ({})", FormatCount(summary.total_failures),
                                              FormatCount(summary.runs_done),
                                              Percent(summary.total_failures, summary.runs_done))});
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
  Table table({{"runs", Align::kRight}, {"type", Align::kRight}, {"total failure", Align::kLeft}});
  for (const FailureCount& one : failures) {
    table.AddRow({FormatCount(one.runs), fmt::format("{}", one.type), one.name});
  }
  if (summary.untyped_failures > 0) {
    table.AddRow({FormatCount(summary.untyped_failures), "-", summary.untyped});
  }
  return "\n" + table.ToText();
}

// "6 of 8 refused: no-room-to-spawn: ...", the most frequent first.
std::string RunsWithoutAResult(const CampaignSummary& summary, const std::string& directory) {
  if (summary.runs_without_result.empty()) return {};
  constexpr std::size_t kMostGroups = 8;
  const auto& groups = summary.runs_without_result;
  std::string text = "\nRuns without a result\n";
  for (std::size_t i = 0; i < std::min(kMostGroups, groups.size()); ++i) {
    text += fmt::format("  {} of {} {}: {}\n", FormatCount(groups[i].runs), FormatCount(summary.runs_done),
                        NameOf(groups[i].verdict), Printable(groups[i].message));
    if (LeavesBundle(groups[i].verdict))
      text += fmt::format(
          "    to see {} again: {}\n", groups[i].runs == 1 ? "it" : "the first",
          ShellQuoted(fmt::format("{}/{}/README.txt", directory, BundleName(groups[i].first_run))));
  }
  if (groups.size() > kMostGroups)
    text += fmt::format("  and {} more reasons; see show --json\n", groups.size() - kMostGroups);
  return text;
}

// Rows of the first, the last and generations at even distances between them.
std::vector<std::size_t> ShownGenerations(std::size_t count) {
  std::vector<std::size_t> shown;
  const std::size_t rows = std::min(count, kMostGenerations);
  for (std::size_t i = 0; i < rows; ++i) {
    shown.push_back(rows == 1 ? 0 : (i * (count - 1) + (rows - 1) / 2) / (rows - 1));
  }
  return shown;
}

std::string Generations(const CampaignSummary& summary) {
  if (summary.generations.size() < 2) return {};
  Table table({{"generation", Align::kRight},
               {"runs", Align::kRight},
               {"best", Align::kRight},
               {"mean", Align::kRight},
               {"worst", Align::kRight},
               {"total failures", Align::kRight}});
  for (const std::size_t index : ShownGenerations(summary.generations.size())) {
    const GenerationSummary& generation = summary.generations[index];
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
  std::stable_sort(members.begin(), members.end(), [](const PopulationMember* a, const PopulationMember* b) {
    return a->fitness < b->fitness;
  });
  return members;
}

std::string Members(const CampaignSummary& summary) {
  const std::vector<const PopulationMember*> members = Toughest(summary);
  if (members.empty()) return {};
  Table table({{"test case", Align::kRight},
               {"fitness", Align::kRight},
               {"obstacles", Align::kRight},
               {"born in generation", Align::kRight},
               {"runs", Align::kRight},
               {"latest run", Align::kRight}});
  for (std::size_t i = 0; i < std::min(kMostMembers, members.size()); ++i) {
    const PopulationMember& member = *members[i];
    table.AddRow({fmt::format("{}", member.id), FormatFitness(member.fitness),
                  fmt::format("{}", member.genome.size()), fmt::format("{}", member.birth_generation),
                  FormatCount(member.runs.size()), fmt::format("{}", member.runs.back())});
  }
  std::string text = members.size() > kMostMembers
                         ? fmt::format("\nThe toughest {} of {} test cases\n", kMostMembers, members.size())
                         : "\nThe test cases, toughest first\n";
  return text + table.ToText();
}

struct Hint {
  std::string command;
  std::string meaning;
};

std::string Hints(const std::vector<Hint>& hints) {
  Table table({{"", Align::kLeft}, {"", Align::kLeft}});
  for (const Hint& hint : hints) table.AddRow({hint.command, "# " + hint.meaning});
  return "\nNext commands to try\n" + table.ToText();
}

}  // namespace

namespace {

constexpr const char* kNotReproducible =
    "WARNING: the same run gave different results. The campaign is not reproducible: do not trust its "
    "figures.\n\n";

std::string SweepText(const CampaignSummary& summary, const HintContext& context) {
  const auto finished = std::count_if(summary.searches.begin(), summary.searches.end(),
                                      [](const CampaignSummary& one) { return one.finished; });
  std::string text = fmt::format("{}: {} searches, {} finished, {} runs, {} of them total failures\n\n",
                                 Printable(summary.experiment), summary.searches.size(), finished,
                                 FormatCount(summary.runs_done), FormatCount(summary.total_failures));
  if (summary.nondeterministic > 0) text += kNotReproducible;
  Table table({{"search", Align::kRight},
               {"settings", Align::kLeft},
               {"generation", Align::kRight},
               {"runs", Align::kRight},
               {"best", Align::kRight},
               {"mean", Align::kRight},
               {"total failures", Align::kRight},
               {"state hash", Align::kLeft}});
  constexpr std::size_t kShownDigits = 16;
  for (std::size_t i = 0; i < summary.searches.size(); ++i) {
    const CampaignSummary& one = summary.searches[i];
    table.AddRow({fmt::format("{}", i + 1), Printable(one.settings),
                  fmt::format("{}/{}", one.progress.generation, one.progress.generations),
                  FormatCount(one.runs_done), FormatFitness(one.best_fitness),
                  FormatFitness(one.mean_fitness), FormatCount(one.total_failures),
                  one.state_hash.substr(0, kShownDigits)});
  }
  text += table.ToText();
  std::vector<Hint> hints;
  const std::string directory = ShellQuoted(context.directory);
  if (!summary.finished)
    hints.push_back({fmt::format("{} resume {}", context.program, directory), "go on where it stopped"});
  hints.push_back({fmt::format("{} show {} --json", context.program, directory), "everything, for scripts"});
  return text + Hints(hints);
}

}  // namespace

std::string SummaryText(const CampaignSummary& summary, const HintContext& context) {
  if (!summary.searches.empty()) return SweepText(summary, context);
  const std::string directory = ShellQuoted(context.directory);
  std::string text =
      fmt::format("{}: {}, seed {}, {}\n\n", Printable(summary.experiment), NameOfSearch(summary),
                  summary.seed, summary.finished ? "finished" : "not finished");
  if (summary.nondeterministic > 0) text += kNotReproducible;
  if (summary.runs_done > 0 && summary.runs_failed == summary.runs_done) {
    text += fmt::format("NO RUN GAVE A RESULT: of {} runs none could be simulated to its end.\n\n",
                        FormatCount(summary.runs_done));
  }
  text += Overview(summary) + FailuresByType(summary) + RunsWithoutAResult(summary, context.directory) +
          Generations(summary) + Members(summary);

  std::vector<Hint> hints;
  if (!summary.finished) {
    hints.push_back({fmt::format("{} resume {}", context.program, directory), "go on where it stopped"});
  }
  if (const auto members = Toughest(summary); !members.empty()) {
    const PopulationMember& best = *members.front();
    hints.push_back({fmt::format("{} replay {} {} --svg case-{}.svg", context.program, directory,
                                 best.runs.back(), best.id),
                     "see what happened in the toughest case"});
  }
  hints.push_back({fmt::format("{} show {} --json", context.program, directory), "everything, for scripts"});
  return text + Hints(hints);
}

std::string EvaluationText(const std::vector<EvaluatedCase>& cases, const HintContext& context) {
  Table table({{"file", Align::kLeft},
               {"fitness", Align::kRight},
               {"runs", Align::kRight},
               {"total failures", Align::kRight},
               {"first run", Align::kRight},
               {"", Align::kLeft}});
  const EvaluatedRun* toughest = nullptr;
  for (const EvaluatedCase& evaluated : cases) {
    if (evaluated.runs.empty()) {
      table.AddRow({evaluated.file, "-", "-", "-", "-",
                    evaluated.refused_rule.empty() ? "error" : "refused: " + evaluated.refused_rule});
      continue;
    }
    std::uint64_t failures = 0;
    std::uint64_t without_result = 0;
    for (const EvaluatedRun& run : evaluated.runs) {
      if (run.result.failure.total) ++failures;
      if (run.result.verdict != sim::Verdict::kCompleted) {
        ++without_result;
      } else if (toughest == nullptr || run.result.fitness < toughest->result.fitness) {
        toughest = &run;
      }
    }
    std::string remark;
    if (!evaluated.refused_rule.empty()) {
      remark = "refused: " + evaluated.refused_rule;
    } else if (without_result > 0) {
      remark = fmt::format("{} without a result: {}", without_result,
                           NameOf(evaluated.runs.front().result.verdict));
    }
    const std::optional<double> fitness = MeanFitness(evaluated);
    table.AddRow({evaluated.file, fitness ? FormatFitness(*fitness) : "-", FormatCount(evaluated.runs.size()),
                  FormatCount(failures), fmt::format("{}", evaluated.runs.front().id), remark});
  }
  std::string text = table.ToText();
  if (toughest != nullptr) {
    const std::string directory = ShellQuoted(context.directory);
    text +=
        Hints({{fmt::format("{} replay {} {} --svg run-{}.svg", context.program, directory, toughest->id,
                            toughest->id),
                "see the toughest of these runs"},
               {fmt::format("{} show {} --json", context.program, directory), "everything, for scripts"}});
  }
  return text;
}

}  // namespace gauntlet::master
