#include "search/evolution/crossover.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace gauntlet {

Offspring SwapSegment(const sim::Genome& first, const sim::Genome& second, std::size_t begin,
                      std::size_t end) {
  GAUNTLET_CHECK(first.size() == second.size() && begin <= end && end <= first.size(),
                 fmt::format("genes {} and {}, segment {} to {}", first.size(), second.size(), begin, end));
  Offspring offspring{first, second};
  for (std::size_t i = begin; i < end; ++i) std::swap(offspring.first[i], offspring.second[i]);
  return offspring;
}

Offspring Cross(CrossoverKind kind, const sim::Genome& first, const sim::Genome& second,
                sim::RandomStream& random) {
  const auto genes = static_cast<std::uint32_t>(first.size());
  if (genes < 2 && kind != CrossoverKind::kUniform) return {first, second};
  switch (kind) {
    case CrossoverKind::kSinglePoint:
      return SwapSegment(first, second, 1 + random.Below(genes - 1), genes);
    case CrossoverKind::kDoublePoint: {
      const std::uint32_t one = 1 + random.Below(genes);
      std::uint32_t other = 1 + random.Below(genes - 1);
      if (other >= one) ++other;
      return SwapSegment(first, second, std::min(one, other), std::max(one, other));
    }
    case CrossoverKind::kUniform:
      break;
  }
  Offspring offspring = SwapSegment(first, second, 0, 0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (random.Below(2) == 1) std::swap(offspring.first[i], offspring.second[i]);
  }
  return offspring;
}

}  // namespace gauntlet
