#include "sim/arena/validity.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/check.h"
#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {
namespace {

using enum ValidityRule;

bool AllFinite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string PlaceText(const Vec2& p) {
  return gauntlet::PointText(p.x(), p.y());
}

std::string GeneText(const ObstacleGene& gene, std::size_t index) {
  return "obstacle " + std::to_string(index + 1) + " (x " + NumberText(gene.x) + " m, y " +
         NumberText(gene.y) + " m, " + NumberText(gene.length) + " x " + NumberText(gene.width) + " m at " +
         NumberText(gene.orientation_deg) + " degrees)";
}

// Where the arena lies.
std::optional<Violation> JudgeCenter(const TestCase& test_case, const ArenaRequirements& requirements) {
  const Vec2& center = test_case.center;
  if (center == Vec2::Zero()) return std::nullopt;
  const std::string arena = "the arena lies around " + PlaceText(center) + " m, ";
  if (!center.allFinite()) return Violation{kFiniteNumbers, -1, arena + "which is not finite"};
  if (!requirements.anywhere)
    return Violation{kLimits, -1, arena + "but this scenario is simulated around the origin only"};
  const Vec2 half = Vec2(test_case.side_x, test_case.side_y) / 2.0;
  if ((center.cwiseAbs() + half).maxCoeff() <= kMaxCoordinate) return std::nullopt;
  return Violation{kLimits, -1,
                   arena + "but must end within " + NumberText(kMaxCoordinate) + " m of the origin"};
}

// The rules that concern nothing but the numbers of the arena itself.
std::optional<Violation> JudgeArenaNumbers(const TestCase& test_case, const ArenaRequirements& requirements) {
  const auto broken = [&](ValidityRule rule, const std::string& what) {
    return Violation{rule, -1,
                     "the arena (" + NumberText(test_case.side_x) + " x " + NumberText(test_case.side_y) +
                         " m, walls " + NumberText(test_case.wall_thickness) + " m thick) " + what};
  };
  if (!AllFinite({test_case.side_x, test_case.side_y, test_case.wall_thickness})) {
    return broken(kFiniteNumbers, "has a number that is not finite");
  }
  const auto [shorter, longer] = std::minmax(test_case.side_x, test_case.side_y);
  if (!(shorter > 0.0 && test_case.wall_thickness > 0.0)) {
    return broken(kPositiveSize, "must have positive sides and walls");
  }
  if (shorter < requirements.least_side || longer > kMaxArenaSide) {
    return broken(kLimits, "must have sides of " + NumberText(requirements.least_side) + " to " +
                               NumberText(kMaxArenaSide) + " m");
  }
  if (test_case.wall_thickness < kMinThickness || test_case.wall_thickness > shorter / 2.0) {
    return broken(kLimits,
                  "must have walls of " + NumberText(kMinThickness) + " m to half of its shorter side");
  }
  const double cell = requirements.cell_size;
  if (!(cell > 0.0 && test_case.side_x / cell * (test_case.side_y / cell) <= kMaxCells)) {
    return broken(kLimits, "has more than " + NumberText(kMaxCells / 1e6) + " million cells of " +
                               NumberText(cell) + " m, in which ways are looked for");
  }
  return JudgeCenter(test_case, requirements);
}

// Spawn area, number of robots, number of obstacles.
std::optional<Violation> JudgeSwarmNumbers(const TestCase& test_case) {
  if (test_case.spawn_area) {
    const auto& [min, max] = *test_case.spawn_area;
    const std::string area = "the spawn area from " + PlaceText(min) + " to " + PlaceText(max) + " m ";
    if (!(min.allFinite() && max.allFinite())) {
      return Violation{kFiniteNumbers, -1, area + "has a number that is not finite"};
    }
    if (!((min.array() <= max.array()).all())) {
      return Violation{kPositiveSize, -1, area + "must go from its least to its greatest corner"};
    }
    if (std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff()) > kMaxCoordinate) {
      return Violation{kLimits, -1,
                       area + "must lie within " + NumberText(kMaxCoordinate) + " m of the origin"};
    }
  }
  if (test_case.robots && (*test_case.robots < 1 || *test_case.robots > kMaxRobots)) {
    return Violation{kLimits, -1,
                     std::to_string(*test_case.robots) + " robots; want 1 to " + std::to_string(kMaxRobots)};
  }
  const std::size_t poses = test_case.start_poses.size();
  if (poses > 0 && test_case.robots != static_cast<int>(poses)) {
    return Violation{kLimits, -1,
                     std::to_string(poses) + " start poses for " +
                         std::to_string(test_case.robots.value_or(0)) +
                         " robots; want one for each, or none"};
  }
  for (const Pose& pose : test_case.start_poses) {
    if (pose.position.allFinite() && std::abs(pose.heading) <= kPi) continue;
    return Violation{kLimits, -1,
                     "the start pose at " + PlaceText(pose.position) + " m has the heading " +
                         NumberText(pose.heading) + "; want finite numbers, the heading from -pi to pi"};
  }
  if (test_case.obstacles.size() > kMaxObstacles) {
    return Violation{kLimits, -1,
                     std::to_string(test_case.obstacles.size()) + " obstacles; want at most " +
                         std::to_string(kMaxObstacles)};
  }
  return std::nullopt;
}

// The grid without obstacles, or one to stand in for it when its numbers cannot be built.
OccupancyGrid EmptyGrid(const TestCase& test_case, const ArenaRequirements& requirements) {
  if (JudgeArenaNumbers(test_case, requirements))
    return OccupancyGrid(Arena(TestCase{}), requirements.inflation);
  TestCase empty;
  empty.side_x = test_case.side_x;
  empty.side_y = test_case.side_y;
  empty.wall_thickness = test_case.wall_thickness;
  empty.center = test_case.center;
  return GridFor(empty, requirements);
}

Violation BrokenByGene(ValidityRule rule, const ObstacleGene& gene, std::size_t index,
                       const std::string& what) {
  return {rule, static_cast<int>(index), GeneText(gene, index) + " " + what};
}

// The rules that concern nothing but the gene's numbers; its index counts from 0.
std::optional<Violation> JudgeGeneNumbers(const ObstacleGene& gene, std::size_t index) {
  const auto broken = [&](ValidityRule rule, const std::string& what) {
    return BrokenByGene(rule, gene, index, what);
  };
  if (!AllFinite({gene.x, gene.y, gene.length, gene.width, gene.orientation_deg})) {
    return broken(kFiniteNumbers, "has a number that is not finite");
  }
  const auto [shorter, longer] = std::minmax(gene.length, gene.width);
  if (!(shorter > 0.0)) return broken(kPositiveSize, "must have a positive length and width");
  if (shorter < kMinThickness || longer > kMaxObstacleSize) {
    return broken(kLimits, "must have a length and width of " + NumberText(kMinThickness) + " to " +
                               NumberText(kMaxObstacleSize) + " m");
  }
  if (std::max(std::fabs(gene.x), std::fabs(gene.y)) > kMaxCoordinate) {
    return broken(kLimits, "must have its centre within " + NumberText(kMaxCoordinate) + " m of the origin");
  }
  const bool finite =
      std::all_of(gene.path.begin(), gene.path.end(), [](const Vec2& p) { return p.allFinite(); });
  if (!finite || !std::isfinite(gene.speed)) {
    return broken(kFiniteNumbers, "moves along numbers that are not finite");
  }
  if (gene.speed < 0.0 || gene.speed > kMaxObstacleSpeed) {
    return broken(kLimits, "moves at " + NumberText(gene.speed) + " m/s; want 0 to " +
                               NumberText(kMaxObstacleSpeed) + " m/s");
  }
  const std::string path = "has a path of " + std::to_string(gene.path.size()) + " points";
  if (gene.path.empty() != (gene.speed == 0.0)) {
    return broken(kLimits, path + " and a speed of " + NumberText(gene.speed) + " m/s; want both or neither");
  }
  if (gene.path.size() > kMaxObstaclePath) {
    return broken(kLimits, path + "; want at most " + std::to_string(kMaxObstaclePath));
  }
  for (const Vec2& point : gene.path) {
    if (point.cwiseAbs().maxCoeff() <= kMaxCoordinate) continue;
    return broken(kLimits, "moves to " + PlaceText(point) + " m; want paths within " +
                               NumberText(kMaxCoordinate) + " m of the origin");
  }
  return std::nullopt;
}

// Whether anything of the obstacle is ever within the outer faces of the walls, judged by the smallest
// axis-aligned rectangle around it.
bool ReachesArena(const ObstacleGene& gene, const Vec2& middle, const Vec2& outer) {
  const OrientedBox box = BoxOf(gene);
  const Vec2 reach = outer + BoundingHalfExtents(box);
  const auto reaches = [&](const Vec2& center) {
    return ((center - middle).cwiseAbs().array() <= reach.array()).all();
  };
  return reaches(box.center) || std::any_of(gene.path.begin(), gene.path.end(), reaches);
}

// The least distance of the obstacle from a point or a box on its whole path.
template <typename Place>
double LeastDistance(const ObstacleGene& gene, const Place& place) {
  constexpr double kStride = 0.01;  // m between the places of the obstacle that are looked at
  OrientedBox box = BoxOf(gene);
  double least = Distance(box, place);
  for (const Vec2& point : gene.path) {
    const Vec2 from = box.center;
    const double length = std::sqrt((point - from).squaredNorm());
    const int strides = static_cast<int>(length / kStride) + 1;
    for (int i = 1; i <= strides; ++i) {
      box.center = from + static_cast<double>(i) / strides * (point - from);
      least = std::min(least, Distance(box, place));
    }
    box.center = point;
  }
  return least;
}

// The first goal that is as asked; nullptr: none is.
const Vec2* FindGoal(const ArenaRequirements& requirements, const auto& asked) {
  if (asked(requirements.goal)) return &requirements.goal;
  const auto found = std::ranges::find_if(requirements.further_goals, asked);
  return found == requirements.further_goals.end() ? nullptr : &*found;
}

// What the scenario keeps free of obstacles.
std::optional<Violation> JudgePlaces(const ObstacleGene& gene, std::size_t index,
                                     const ArenaRequirements& requirements) {
  const auto too_near = [&](const Vec2& place) {
    return !(LeastDistance(gene, place) >= requirements.clearance);
  };
  const auto broken = [&](const Vec2& place, const std::string& name) {
    return BrokenByGene(kClearance, gene, index,
                        "is " + NumberText(LeastDistance(gene, place)) + " m from the " + name + " " +
                            PlaceText(place) + "; want at least " + NumberText(requirements.clearance) +
                            " m");
  };
  if (requirements.asks_for_path && requirements.clearance > 0.0) {
    if (too_near(requirements.start)) return broken(requirements.start, "start");
    if (const Vec2* goal = FindGoal(requirements, too_near)) return broken(*goal, "goal");
  }
  for (std::size_t i = 0; i < requirements.keep_outs.size(); ++i) {
    const auto& [box, radius] = requirements.keep_outs[i];
    if (LeastDistance(gene, box) > radius) continue;
    return BrokenByGene(kKeepOut, gene, index,
                        "touches keep-out " + std::to_string(i + 1) + ", around " + PlaceText(box.center) +
                            ", where no obstacle may be");
  }
  return std::nullopt;
}

// A goal that is not connected with the start; nullptr: there is none.
const Vec2* GoalCutOff(const OccupancyGrid& grid, const ArenaRequirements& requirements) {
  if (!requirements.asks_for_path) return nullptr;
  const Cell start = grid.CellAt(requirements.start);
  return FindGoal(requirements, [&](const Vec2& goal) { return !grid.Connected(start, grid.CellAt(goal)); });
}

// Start and goals free in `grid`; `culprit` begins the message.
std::optional<Violation> JudgeEnds(const OccupancyGrid& grid, const ArenaRequirements& requirements, int gene,
                                   const auto& culprit) {
  if (!requirements.asks_for_path) return std::nullopt;
  const bool start_free = grid.Free(grid.CellAt(requirements.start));
  const Vec2* goal =
      FindGoal(requirements, [&](const Vec2& place) { return !grid.Free(grid.CellAt(place)); });
  if (start_free && goal == nullptr) return std::nullopt;
  const std::string room =
      "; a robot's centre needs " + NumberText(requirements.inflation) + " m of room there";
  if (!start_free) {
    return Violation{kStartBlocked, gene,
                     culprit() + " blocks the start " + PlaceText(requirements.start) + room};
  }
  return Violation{kGoalBlocked, gene, culprit() + " blocks the goal " + PlaceText(*goal) + room};
}

std::optional<Violation> JudgePath(const OccupancyGrid& grid, const ArenaRequirements& requirements, int gene,
                                   const auto& culprit) {
  const Vec2* goal = GoalCutOff(grid, requirements);
  if (goal == nullptr) return std::nullopt;
  return Violation{kNoPath, gene,
                   culprit() + " leaves no path from " + PlaceText(requirements.start) + " to " +
                       PlaceText(*goal) + " for a robot's body"};
}

}  // namespace

std::string_view NameOf(ValidityRule rule) {
  constexpr std::string_view kNames[] = {
      "finite-numbers", "positive-size", "contained-obstacle", "start-blocked", "goal-blocked", "clearance",
      "no-path",        "limits",        "outside-arena",      "keep-out",      "open-area"};
  return kNames[static_cast<std::size_t>(rule)];
}

OccupancyGrid GridFor(const TestCase& test_case, const ArenaRequirements& requirements) {
  OccupancyGrid grid(Arena(test_case), requirements.inflation, requirements.cell_size);
  for (const RoundedBox& shape : requirements.standing) grid.AddObstacle(shape);
  return grid;
}

std::optional<Violation> CheckValidity(const TestCase& test_case, const ArenaRequirements& requirements) {
  const IncrementalValidity empty(test_case, requirements);
  if (empty.arena_violation()) return empty.arena_violation();
  IncrementalValidity all = empty;
  const auto fits = [&](const ObstacleGene& gene) { return !all.TryAppendWhateverPathIsLeft(gene); };
  if (std::ranges::all_of(test_case.obstacles, fits) && all.LeavesPath()) return std::nullopt;
  IncrementalValidity one_by_one = empty;
  for (const ObstacleGene& gene : test_case.obstacles) {
    if (std::optional<Violation> violation = one_by_one.TryAppend(gene)) return violation;
  }
  GAUNTLET_CHECK(false, "a case is valid gene by gene, but not as a whole");
}

IncrementalValidity::IncrementalValidity(const TestCase& empty_arena, const ArenaRequirements& requirements)
    : requirements_(requirements),
      center_(empty_arena.center),
      outer_(Vec2(empty_arena.side_x, empty_arena.side_y) / 2.0 + Vec2::Constant(empty_arena.wall_thickness)),
      arena_violation_(JudgeArenaNumbers(empty_arena, requirements)),
      grid_(EmptyGrid(empty_arena, requirements)),
      candidate_(grid_) {
  if (!arena_violation_) arena_violation_ = JudgeSwarmNumbers(empty_arena);
  const auto itself = [&] {
    return std::string(requirements.standing.empty() ? "the wall" : "what stands in the arena itself");
  };
  if (!arena_violation_) arena_violation_ = JudgeEnds(grid_, requirements_, -1, itself);
  if (!arena_violation_) arena_violation_ = JudgePath(grid_, requirements_, -1, itself);
  if (requirements_.open_share > 0.0)
    least_open_ = requirements_.open_share * static_cast<double>(OpenCells(grid_));
}

std::size_t IncrementalValidity::OpenCells(const OccupancyGrid& grid) const {
  const std::vector<std::uint8_t> open = grid.Reachable(grid.CellAt(requirements_.start));
  return static_cast<std::size_t>(std::ranges::count(open, std::uint8_t{1}));
}

bool IncrementalValidity::LeavesPath() const {
  if (GoalCutOff(grid_, requirements_) != nullptr) return false;
  return least_open_ == 0.0 || static_cast<double>(OpenCells(grid_)) >= least_open_;
}

std::optional<Violation> IncrementalValidity::TryAppend(const ObstacleGene& gene) {
  if (std::optional<Violation> violation = JudgeGene(gene)) return violation;
  const std::size_t index = boxes_.size();
  if (std::optional<Violation> violation = JudgePath(candidate_, requirements_, static_cast<int>(index),
                                                     [&] { return GeneText(gene, index); })) {
    return violation;
  }
  if (least_open_ > 0.0) {
    const auto open = static_cast<double>(OpenCells(candidate_));
    if (open < least_open_) {
      const double share = open / least_open_ * requirements_.open_share;
      return BrokenByGene(kOpenArea, gene, index,
                          "leaves a robot from " + PlaceText(requirements_.start) + " " +
                              NumberText(std::round(1000.0 * share) / 10.0) +
                              " % of what it reaches in the empty arena; want at least " +
                              NumberText(100.0 * requirements_.open_share) + " %");
    }
  }
  Take(gene);
  return std::nullopt;
}

std::optional<Violation> IncrementalValidity::TryAppendWhateverPathIsLeft(const ObstacleGene& gene) {
  if (std::optional<Violation> violation = JudgeGene(gene)) return violation;
  Take(gene);
  return std::nullopt;
}

void IncrementalValidity::Take(const ObstacleGene& gene) {
  std::swap(grid_, candidate_);
  boxes_.push_back(BoxOf(gene));
}

std::optional<Violation> IncrementalValidity::JudgeGene(const ObstacleGene& gene) {
  if (arena_violation_) return arena_violation_;
  const std::size_t index = boxes_.size();
  if (std::optional<Violation> violation = JudgeGeneNumbers(gene, index)) return violation;
  if (!ReachesArena(gene, center_, outer_)) {
    const bool in_middle = center_ == Vec2::Zero();
    return BrokenByGene(kOutsideArena, gene, index,
                        "lies outside the arena, which " +
                            (in_middle ? "ends at x = " + NumberText(outer_.x()) +
                                             " m and y = " + NumberText(outer_.y()) + " m with its walls"
                                       : "reaches from " + PlaceText(center_ - outer_) + " to " +
                                             PlaceText(center_ + outer_) + " m with its walls"));
  }
  const OrientedBox box = BoxOf(gene);
  const auto around = std::find_if(boxes_.begin(), boxes_.end(),
                                   [&](const OrientedBox& earlier) { return ContainsBox(earlier, box); });
  if (around != boxes_.end()) {
    return BrokenByGene(kContainedObstacle, gene, index,
                        "lies wholly inside obstacle " + std::to_string(around - boxes_.begin() + 1));
  }
  if (std::optional<Violation> violation = JudgePlaces(gene, index, requirements_)) return violation;
  candidate_ = grid_;
  candidate_.AddObstacle(box);
  return JudgeEnds(candidate_, requirements_, static_cast<int>(index), [&] { return GeneText(gene, index); });
}

}  // namespace gauntlet::sim
