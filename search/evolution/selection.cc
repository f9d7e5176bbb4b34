#include "search/evolution/selection.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "base/check.h"

namespace gauntlet {

bool Fitter(const Individual& a, const Individual& b) {
  return a.fitness != b.fitness ? a.fitness < b.fitness : a.id > b.id;
}

void KeepFittest(std::vector<Individual>& individuals, std::size_t count) {
  GAUNTLET_CHECK(count <= individuals.size(), std::to_string(count));
  std::sort(individuals.begin(), individuals.end(), Fitter);
  individuals.resize(count);
  std::sort(individuals.begin(), individuals.end(),
            [](const Individual& a, const Individual& b) { return a.id < b.id; });
}

std::array<std::size_t, 2> TwoFittest(const std::vector<Individual>& individuals) {
  GAUNTLET_CHECK(individuals.size() >= 2, std::to_string(individuals.size()));
  std::vector<std::size_t> order(individuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::partial_sort(order.begin(), order.begin() + 2, order.end(),
                    [&](std::size_t a, std::size_t b) { return Fitter(individuals[a], individuals[b]); });
  return {order[0], order[1]};
}

std::array<std::size_t, 2> TwoAtRandom(std::size_t count, sim::RandomStream& random) {
  GAUNTLET_CHECK(count >= 2, std::to_string(count));
  const std::size_t first = random.Below(static_cast<std::uint32_t>(count));
  std::size_t second = random.Below(static_cast<std::uint32_t>(count - 1));
  if (second >= first) ++second;
  return {first, second};
}

std::vector<std::size_t> Shuffled(std::size_t count, sim::RandomStream& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t left = count; left > 1; --left) {
    std::swap(order[left - 1], order[random.Below(static_cast<std::uint32_t>(left))]);
  }
  return order;
}

}  // namespace gauntlet
