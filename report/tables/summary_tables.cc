#include "report/tables/summary_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "base/check.h"
#include "base/printable.h"
#include "proto/run_text.h"
#include "search/archive/failure_archive.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

Json IdsJson(const std::vector<std::uint64_t>& ids) {
  Json list = Json::array();
  for (const std::uint64_t id : ids) list.push_back(JsonValue(id));
  return list;
}

// Keys as in case files (proto/run.proto, message Obstacle), so that a genome can be copied into one.
Json GenomeJson(const sim::Genome& genome) {
  Json list = Json::array();
  for (const sim::ObstacleGene& gene : genome) {
    list.push_back({{"x", gene.x},
                    {"y", gene.y},
                    {"length", gene.length},
                    {"width", gene.width},
                    {"orientationDeg", gene.orientation_deg}});
    if (gene.Moves()) {
      Json path = Json::array();
      for (const sim::Vec2& point : gene.path) path.push_back({{"x", point.x()}, {"y", point.y()}});
      list.back()["motion"] = {{"speed", gene.speed}, {"path", std::move(path)}};
    }
    if (gene.Lit()) list.back()["light"] = sim::NameOf(gene.light);
  }
  return list;
}

// "12 of 60 runs (20.0 %)"
std::string RunsText(std::uint64_t counted, std::uint64_t runs) {
  const double share = static_cast<double>(counted) / static_cast<double>(runs);
  return fmt::format("{} of {} runs ({})", FormatCount(counted), FormatCount(runs),
                     std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share));
}

std::string TypesInShort(const SearchSummary& summary) {
  std::string text = fmt::format("{} of {}", summary.runs_of_type.size(), summary.types.types.size());
  if (summary.untyped_failures == 0) return text;
  return fmt::format("{}; {} {} {}", text, FormatCount(summary.untyped_failures),
                     summary.untyped_failures == 1 ? "failure" : "failures", summary.types.untyped);
}

}  // namespace

std::size_t CellsOf(const ArchiveView& archive) {
  std::size_t cells = 1;
  for (const controllers::DescriptorAxis& axis : archive.axes) cells *= static_cast<std::size_t>(axis.parts);
  return cells;
}

std::string RangeText(const controllers::DescriptorAxis& axis, int part) {
  const double width = (axis.max - axis.min) / axis.parts;
  return fmt::format("{:.4g} to {:.4g}", axis.min + part * width, axis.min + (part + 1) * width);
}

const PopulationMember& MemberOf(const SearchSummary& summary, const ArchivedFailure& failure) {
  const auto member = std::ranges::find(summary.population, failure.individual, &PopulationMember::id);
  GAUNTLET_CHECK(member != summary.population.end(), "every archived failure is in the population");
  return *member;
}

std::vector<const PopulationMember*> SmallestFirst(const SearchSummary& summary) {
  std::vector<const PopulationMember*> members;
  for (const ArchivedFailure& failure : summary.archive.failures)
    members.push_back(&MemberOf(summary, failure));
  std::ranges::stable_sort(members, {}, [](const auto* member) { return SizeOf(member->genome); });
  return members;
}

std::optional<ToughestCase> ToughestCaseOf(const CampaignSummary& summary) {
  const SearchSummary* only = summary.OnlySearch();
  if (only != nullptr && !only->archive.failures.empty()) {
    const PopulationMember& smallest = *SmallestFirst(*only).front();
    if (smallest.runs.empty()) return std::nullopt;
    return ToughestCase{&smallest, smallest.runs.front()};
  }
  std::optional<ToughestCase> toughest;
  for (const SearchSummary& search : summary.searches) {
    for (const PopulationMember& member : search.population) {
      if (!std::isfinite(member.fitness) || member.runs.empty()) continue;
      if (toughest && member.fitness == toughest->member->fitness) ++toughest->as_tough;
      if (!toughest || member.fitness < toughest->member->fitness) toughest = {&member, member.runs.back()};
    }
  }
  return toughest;
}

void AddTally(const SearchTally& tally, const SearchSummary* only, Table& table) {
  const SearchProgress& progress = tally.progress;
  if (only != nullptr && progress.generations > 1)
    table.AddRow({"generations", fmt::format("{} of {}", progress.generation, progress.generations)});
  table.AddRow({"runs", FormatCount(tally.runs_done) +
                            (tally.runs_failed == 0
                                 ? ""
                                 : fmt::format(", {} of them without a result (crashed, hung, refused)",
                                               FormatCount(tally.runs_failed)))});
  table.AddRow({"test cases", fmt::format("{} different", FormatCount(tally.distinct_individuals))});
  if (only != nullptr) {
    const SearchRow* search = FindSearch(only->search);
    table.AddRow(
        {"fitness", fmt::format("best {}   mean {}   worst {}   (of the {}; lower = tougher)",
                                FormatFitness(tally.fitness.lowest()), FormatFitness(tally.fitness.mean()),
                                FormatFitness(tally.fitness.highest()),
                                NameOf(search == nullptr ? Individuals::kCases : search->individuals))});
    if (!only->failing.empty())
      table.AddRow(
          {"failing", fmt::format("{}: {}", RunsText(tally.failing_runs, tally.runs_done), only->failing)});
  }
  table.AddRow({"total failures", RunsText(tally.total_failures, tally.runs_done)});
  if (only == nullptr) return;
  if (tally.total_failures > 0 && !only->types.types.empty())
    table.AddRow({"failure types", TypesInShort(*only)});
  table.AddRow({"state hash", only->state_hash});
}

void AddReproducibility(const CampaignSummary& summary, Table& table) {
  if (summary.reproducibility.observed())
    table.AddRow({"reproducible", Printable(InWords(summary.reproducibility))});
}

std::string WhyNotReproducible(const CampaignSummary& summary) {
  return fmt::format(
      "The controller '{}' of the plug-in is not reproducible: it uses the time, addresses, or chance that "
      "the run does not seed. Or else a worker is broken: log/master.log names those that disagree.",
      fmt::join(summary.plugin_controllers, "' or '"));
}

std::vector<std::string> WarningsOf(const CampaignSummary& summary) {
  std::vector<std::string> warnings;
  if (summary.nondeterministic > 0) {
    warnings.emplace_back(
        "WARNING: the same run gave different results. The campaign is not reproducible: do not trust its "
        "figures.");
    if (!summary.plugin_controllers.empty()) warnings.push_back(WhyNotReproducible(summary));
  }
  if (summary.lone_verdicts > 0) {
    warnings.push_back(fmt::format(
        "{} runs without a result stand on the word of one worker each: there was no other to ask. "
        "`replay` shows whether they end so elsewhere.",
        FormatCount(summary.lone_verdicts)));
  }
  return warnings;
}

Table SearchesTable(const CampaignSummary& summary, std::size_t most) {
  constexpr std::size_t kShownDigits = 16;
  const bool generations = std::ranges::any_of(
      summary.searches, [](const SearchSummary& one) { return one.progress.generations > 1; });
  Table table({">search", "settings", generations ? ">generation" : ForPrograms(""), ">runs",
               generations ? ">toughest fitness at the end" : ">toughest fitness",
               generations ? ">mean at the end" : ">mean fitness", ">total failures",
               OnTerminals("state hash"), OnPages("finished")});
  for (const SearchSummary& one : summary.searches) {
    if (table.size() == most) break;
    table.AddRow({table.size() + 1, one.settings,
                  generations ? fmt::format("{}/{}", one.progress.generation, one.progress.generations) : "",
                  CountCell(one.runs_done), FitnessCell(one.fitness.lowest()),
                  FitnessCell(one.fitness.mean()), CountCell(one.total_failures),
                  one.state_hash.substr(0, kShownDigits), one.finished});
  }
  return table;
}

Table GenerationTable(const SearchSummary& summary) {
  Table table({{">generation", "generation"},
               {">runs", "runs"},
               {">best", "best_fitness"},
               {">mean", "mean_fitness"},
               {">worst", "worst_fitness"},
               {">total failures", "total_failures"}});
  for (const GenerationSummary& one : summary.generations) {
    table.AddRow({one.generation, CountCell(one.runs), FitnessCell(one.fitness.lowest()),
                  FitnessCell(one.fitness.mean()), FitnessCell(one.fitness.highest()),
                  CountCell(one.total_failures)});
  }
  return table;
}

Table PopulationTable(const std::vector<const PopulationMember*>& members, bool named) {
  const bool bred = std::ranges::any_of(members, [](const auto* one) { return one->birth_generation > 1; });
  Table table({{">test case", "id"},
               {">fitness", "fitness"},
               {">obstacles"},
               bred ? Column(">born in generation", "birth_generation") : ForPrograms("birth_generation"),
               ForPrograms("parents"),
               ForPrograms("genome"),
               {">runs", "runs"},
               {">latest run"},
               {named ? "name" : "", "name?"}});
  for (const PopulationMember* one : members) {
    table.AddRow({one->id, FitnessCell(one->fitness), one->genome.size(), one->birth_generation,
                  JsonCell(IdsJson(one->parents)), JsonCell(GenomeJson(one->genome)),
                  JsonCell(IdsJson(one->runs), FormatCount(one->runs.size())),
                  one->runs.empty() ? Cell() : Cell(proto::RunText(one->runs.back()), one->runs.back()),
                  TextCell(one->name)});
  }
  return table;
}

Table FailureTypeTable(const SearchSummary& summary) {
  Table table({{">type", "type"}, {"total failure", "name"}, {">runs", "runs"}});
  for (const controllers::FailureType& one : summary.types.types) {
    const auto runs = summary.runs_of_type.find(one.type);
    table.AddRow({one.type, one.name, CountCell(runs == summary.runs_of_type.end() ? 0 : runs->second)});
  }
  return table;
}

Table ArchiveTable(const SearchSummary& summary, const std::string& replay) {
  std::vector<Column> columns = {ForPrograms("cell"),         {">test case", "individual"},
                                 {">obstacles", "obstacles"}, {">length [m]", "length"},
                                 {">failed", "k n"},          ForPrograms("interval"),
                                 ForPrograms("middle")};
  for (const controllers::DescriptorAxis& axis : summary.archive.axes)
    columns.emplace_back(">mean " + axis.metric);
  columns.insert(columns.end(), {{">run", "run"}, {""}});
  Table table(columns);
  std::vector<ArchivedFailure> failures = summary.archive.failures;
  std::ranges::stable_sort(failures, {}, [&](const ArchivedFailure& failure) {
    return SizeOf(MemberOf(summary, failure).genome);
  });
  for (const ArchivedFailure& failure : failures) {
    const PopulationMember& member = MemberOf(summary, failure);
    const LayoutSize size = SizeOf(member.genome);
    const auto k = static_cast<std::uint32_t>(failure.failures);
    const auto n = static_cast<std::uint32_t>(failure.runs);
    std::vector<Cell> row = {
        JsonCell(failure.cell),  failure.individual,
        size.obstacles,          DecimalCell(size.length, 1),
        OutOfCell(k, n),         PercentCell(analysis::WilsonInterval(k, n, analysis::kConfidence)),
        JsonCell(failure.middle)};
    for (const double value : failure.middle) row.push_back(DecimalCell(value, 2));
    const RunId run = member.runs.empty() ? 0 : member.runs.front();
    row.push_back(run == 0 ? Cell() : Cell(proto::RunText(run), run));
    row.emplace_back(fmt::format("{} {} --svg case-{}.svg", replay, proto::RunText(run), failure.individual));
    table.AddRow(std::move(row));
  }
  return table;
}

Table ArchiveMap(const SearchSummary& summary) {
  const ArchiveView& archive = summary.archive;
  const controllers::DescriptorAxis& across = archive.axes[0];
  const controllers::DescriptorAxis& up = archive.axes[1];
  std::vector<Column> columns = {""};
  for (int x = 0; x < across.parts; ++x) columns.emplace_back(">" + RangeText(across, x));
  Table table(columns);
  for (int y = up.parts - 1; y >= 0; --y) {
    std::vector<Cell> row = {RangeText(up, y)};
    for (int x = 0; x < across.parts; ++x) {
      const auto here = std::ranges::find(archive.failures, std::vector<int>{x, y}, &ArchivedFailure::cell);
      row.push_back(here == archive.failures.end() ? Cell(".") : MemberOf(summary, *here).genome.size());
    }
    table.AddRow(std::move(row));
  }
  return table;
}

}  // namespace gauntlet
