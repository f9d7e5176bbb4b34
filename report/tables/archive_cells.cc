#include "report/tables/archive_cells.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "search/archive/failure_archive.h"

namespace gauntlet {

std::size_t CellsOf(const ArchiveView& archive) {
  std::size_t cells = 1;
  for (const CellAxis& axis : archive.axes) cells *= static_cast<std::size_t>(axis.parts);
  return cells;
}

std::string RangeText(const CellAxis& axis, int part) {
  const double width = (axis.max - axis.min) / axis.parts;
  return fmt::format("{:.4g} to {:.4g}", axis.min + part * width, axis.min + (part + 1) * width);
}

const PopulationMember& MemberOf(const CampaignSummary& summary, const ArchivedFailure& failure) {
  const auto member = std::ranges::find(summary.population, failure.individual, &PopulationMember::id);
  GAUNTLET_CHECK(member != summary.population.end(), "every archived failure is in the population");
  return *member;
}

std::vector<ArchivedFailure> BySize(const CampaignSummary& summary) {
  std::vector<ArchivedFailure> failures = summary.archive.failures;
  std::ranges::stable_sort(failures, {}, [&](const ArchivedFailure& failure) {
    return SizeOf(MemberOf(summary, failure).genome);
  });
  return failures;
}

}  // namespace gauntlet
