#include "search/experiment/seed_list.h"

#include "base/parse_number.h"
#include "base/split.h"

namespace gauntlet {

std::optional<std::vector<std::uint64_t>> ParseSeedList(const std::string& text, std::size_t most) {
  std::vector<std::uint64_t> seeds;
  if (const std::size_t dots = text.find(".."); dots != std::string::npos) {
    const auto first = ParseNumber<std::uint64_t>(text.substr(0, dots));
    const auto last = ParseNumber<std::uint64_t>(text.substr(dots + 2));
    if (!first || !last || *first > *last || *last - *first >= most) return std::nullopt;
    for (std::uint64_t i = 0; i <= *last - *first; ++i) seeds.push_back(*first + i);
    return seeds;
  }
  for (const std::string& item : Split(text, ',')) {
    const auto seed = ParseNumber<std::uint64_t>(item);
    if (!seed || seeds.size() == most) return std::nullopt;
    seeds.push_back(*seed);
  }
  return seeds.empty() ? std::nullopt : std::optional(seeds);
}

}  // namespace gauntlet
