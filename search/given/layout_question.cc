#include "search/given/layout_question.h"

#include <algorithm>
#include <numeric>

namespace gauntlet {

Layout Without(const Layout& layout, std::size_t obstacle) {
  Layout rest = layout;
  const auto place = std::ranges::find(rest.kept, obstacle) - rest.kept.begin();
  rest.kept.erase(rest.kept.begin() + place);
  rest.obstacles.erase(rest.obstacles.begin() + place);
  return rest;
}

Layout AllOf(const sim::Genome& obstacles) {
  Layout all{std::vector<std::size_t>(obstacles.size()), obstacles};
  std::iota(all.kept.begin(), all.kept.end(), std::size_t{0});
  return all;
}

void LayoutRuns::Add(const LayoutRuns& more) {
  tally.failures += more.tally.failures;
  tally.passes += more.tally.passes;
  tally.errors += more.tally.errors;
  tally.refused += more.tally.refused;
  places.insert(places.end(), more.places.begin(), more.places.end());
  visits.resize(std::max(visits.size(), more.visits.size()));
  for (std::size_t i = 0; i < more.visits.size(); ++i) visits[i] += more.visits[i];
}

}  // namespace gauntlet
