#include "search/archive/layout_proposer.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "sim/arena/arena.h"
#include "sim/arena/path_planner.h"

namespace gauntlet {
namespace {

// Obstacles of a random case that are tried alone: so many nearest to the failure and so many in the way.
constexpr std::array<std::pair<std::ptrdiff_t, std::size_t>, 6> kFirstTried = {
    {{1, 0}, {2, 0}, {2, 1}, {3, 0}, {3, 1}, {4, 1}}};
constexpr std::uint32_t kMostAcross = 3;  // obstacles in a row across the way
constexpr double kOfOne = 0.25;    // chosen: of single obstacles, those that are an elite of one, changed
constexpr int kTries = 20;         // to make a layout that is valid
constexpr int kDraws = 4;          // random cases of which the most promising one is simulated
constexpr double kPathStep = 0.2;  // m, between the points of a path that are looked at

}  // namespace

std::string_view NameOf(Emitter emitter) {
  constexpr std::array<std::string_view, kEmitters> names = {"random", "nearest",  "without", "mirrored",
                                                             "across", "jittered", "recheck"};
  return names[static_cast<std::size_t>(emitter)];
}

LayoutProposer::LayoutProposer(const SearchSetup& setup, const GenomeGenerator& generator, bool places,
                               FailureArchive& archive)
    : generator_(generator),
      places_(places),
      way_{setup.requirements.start, setup.requirements.goal},
      requirements_(setup.requirements),
      archive_(archive) {}

Proposal LayoutProposer::Random(sim::RandomStream& random) const {
  std::optional<sim::TestCase> best;
  double most = -1.0;
  const int draws = places_ && !archive_.shelves().empty() ? kDraws : 1;
  for (int drawn = 0; drawn < draws;) {
    Result<sim::TestCase> test_case = generator_.RandomTestCase(random);
    if (!test_case.ok()) continue;  // Create has found that there are some
    ++drawn;
    const double promise = draws == 1 ? 0.0 : Promise(*test_case);
    if (promise <= most) continue;
    most = promise;
    best = *std::move(test_case);
  }
  return {Emitter::kRandom, std::move(best->obstacles)};
}

double LayoutProposer::Promise(const sim::TestCase& test_case) const {
  const sim::OccupancyGrid grid = GridFor(test_case, requirements_);
  std::set<std::size_t> cells;
  const std::vector<sim::Vec2> path = sim::PlanPath(grid, way_.start, way_.goal);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = (path[i] - path[i - 1]).norm();
    const int points = 1 + static_cast<int>(length / kPathStep);
    for (int k = 0; k <= points; ++k) {
      const sim::Vec2 point = path[i - 1] + (path[i] - path[i - 1]) * (static_cast<double>(k) / points);
      cells.insert(archive_.grid().CellOf({point.x(), point.y()}));
    }
  }
  double promise = 0.0;
  for (const std::size_t cell : cells) {
    const Finding* elite = archive_.EliteOf(cell);
    const std::size_t obstacles =
        elite == nullptr ? 2 * static_cast<std::size_t>(generator_.spec().genes) : elite->size().obstacles;
    promise += static_cast<double>(obstacles - 1);
  }
  return promise;
}

std::optional<Proposal> LayoutProposer::Mirrored() {
  for (const auto& [cell, shelf] : archive_.shelves()) {
    const Finding& elite = shelf.front();
    if (elite.mirrored) continue;
    const Descriptor middle = elite.Middle();
    const sim::Vec2 target = gauntlet::Mirrored({middle[0], middle[1]}, way_);
    const std::size_t target_cell = archive_.grid().CellOf({target.x(), target.y()});
    if (!archive_.WouldWin(target_cell, elite.size())) continue;
    archive_.SetMirrored(cell);
    std::optional<sim::Genome> mirrored =
        gauntlet::Mirrored(elite.individual.test_case.obstacles, way_, generator_);
    if (!mirrored) continue;
    return Proposal{Emitter::kMirrored, *std::move(mirrored), elite.individual.id, target_cell};
  }
  return std::nullopt;
}

std::uint32_t LayoutProposer::MostAcross() const {
  return std::min(kMostAcross, static_cast<std::uint32_t>(generator_.spec().genes));
}

std::uint32_t LayoutProposer::DrawMostAcross(sim::RandomStream& random) const {
  std::vector<std::uint32_t> most;
  for (const auto& [size, shelf] : archive_.shelves()) {
    const auto fewer = static_cast<std::uint32_t>(shelf.front().size().obstacles - 1);
    if (fewer > 0) most.push_back(std::min(fewer, MostAcross()));
  }
  const std::size_t empty = archive_.grid().cells() - archive_.shelves().size();
  if (empty + most.size() == 0) return 0;
  const std::uint32_t cell = random.Below(static_cast<std::uint32_t>(empty + most.size()));
  return cell < empty ? MostAcross() : most[cell - empty];
}

std::optional<Proposal> LayoutProposer::Across(bool needed, sim::RandomStream& random) const {
  if (places_ && needed) return Needed(random);
  for (int i = 0; i < kTries; ++i) {
    const sim::Vec2 place = DrawPlace(random);
    const auto count = static_cast<int>(1 + random.Below(MostAcross()));
    // One obstacle breaks a swarm where it stands, if anywhere.
    const Finding* elite =
        places_ && count == 1 ? archive_.EliteOf(archive_.grid().CellOf({place.x(), place.y()})) : nullptr;
    if (elite != nullptr && elite->size().obstacles == 1) continue;
    std::optional<sim::Genome> row = gauntlet::Across(place, count, way_, generator_, random);
    if (!row) continue;
    return Proposal{Emitter::kAcross, *std::move(row)};
  }
  return std::nullopt;
}

std::optional<Proposal> LayoutProposer::Needed(sim::RandomStream& random) const {
  const std::uint32_t most = DrawMostAcross(random);
  for (int i = 0; i < kTries && most > 0; ++i) {
    const auto count = static_cast<int>(1 + random.Below(most));
    const Finding* elite = count == 1 && random.Chance(kOfOne) ? DrawEliteOfOne(random) : nullptr;
    const sim::Vec2 place = DrawPlace(random);
    std::optional<sim::Genome> row =
        elite == nullptr ? gauntlet::Across(place, count, way_, generator_, random)
                         : gauntlet::Jittered(elite->individual.test_case.obstacles, generator_, random);
    if (row && count == 1) row = Longest(*row, generator_, random);
    if (!row) continue;
    if (elite == nullptr) return Proposal{Emitter::kAcross, *std::move(row)};
    return Proposal{Emitter::kJittered, *std::move(row), elite->individual.id,
                    archive_.grid().CellOf(elite->Middle())};
  }
  return std::nullopt;
}

const Finding* LayoutProposer::DrawEliteOfOne(sim::RandomStream& random) const {
  std::vector<const Finding*> elites;
  for (const auto& [size, shelf] : archive_.shelves()) {
    if (shelf.front().size().obstacles == 1) elites.push_back(&shelf.front());
  }
  return elites.empty() ? nullptr : elites[random.Below(static_cast<std::uint32_t>(elites.size()))];
}

const Finding& LayoutProposer::DrawElite(sim::RandomStream& random) const {
  const auto index = random.Below(static_cast<std::uint32_t>(archive_.shelves().size()));
  return std::next(archive_.shelves().begin(), index)->second.front();
}

std::optional<Proposal> LayoutProposer::Jittered(sim::RandomStream& random) const {
  for (int i = 0; i < kTries; ++i) {
    const Finding& elite = DrawElite(random);
    sim::Genome obstacles = elite.individual.test_case.obstacles;
    if (obstacles.size() < 2) continue;
    obstacles = Without(obstacles, random.Below(static_cast<std::uint32_t>(obstacles.size())));
    std::optional<sim::Genome> jittered = gauntlet::Jittered(obstacles, generator_, random);
    if (!jittered) continue;
    return Proposal{Emitter::kJittered, *std::move(jittered), elite.individual.id,
                    archive_.grid().CellOf(elite.Middle())};
  }
  return std::nullopt;
}

std::optional<Proposal> LayoutProposer::Changed(const Individual& individual,
                                                sim::RandomStream& random) const {
  for (int i = 0; i < kTries; ++i) {
    if (auto changed = gauntlet::Jittered(individual.test_case.obstacles, generator_, random))
      return Proposal{Emitter::kJittered, *std::move(changed), individual.id};
  }
  return std::nullopt;
}

sim::Vec2 LayoutProposer::DrawPlace(sim::RandomStream& random) const {
  return way_.start + (way_.goal - way_.start) * random.Uniform();
}

std::vector<std::size_t> LayoutProposer::Order(const sim::Genome& obstacles,
                                               const Descriptor& failure) const {
  if (places_) return ByDistance(obstacles, {failure[0], failure[1]});
  return ByDistanceToWay(obstacles, way_);
}

std::vector<sim::Genome> LayoutProposer::PartsNear(const sim::Genome& obstacles,
                                                   const Descriptor& failure) const {
  std::vector<sim::Genome> parts;
  const std::vector<std::size_t> nearest = Order(obstacles, failure);
  const std::vector<std::size_t> in_the_way = ByDistanceToWay(obstacles, way_);
  for (const auto& [near, on_way] : kFirstTried) {
    std::vector<std::size_t> kept(nearest.begin(), nearest.begin() + std::min(near, std::ssize(nearest)));
    std::size_t missing = on_way;
    for (const std::size_t index : in_the_way) {
      if (missing == 0 || std::ranges::find(kept, index) != kept.end()) continue;
      kept.push_back(index);
      --missing;
    }
    if (kept.size() >= obstacles.size()) break;
    parts.push_back(Keep(obstacles, std::move(kept)));
  }
  return parts;
}

std::vector<sim::Genome> LayoutProposer::PartsWithoutOne(const sim::Genome& obstacles,
                                                         const Descriptor& failure) const {
  std::vector<std::size_t> order = Order(obstacles, failure);
  std::ranges::reverse(order);
  std::vector<sim::Genome> parts;
  for (const std::size_t index : order) parts.push_back(Without(obstacles, index));
  return parts;
}

}  // namespace gauntlet
