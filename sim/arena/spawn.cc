#include "sim/arena/spawn.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {
namespace {

constexpr double kGap = 0.01;  // m, least between bodies, and between a body and an obstacle or wall
constexpr int kTriesPerRobot = 100;
constexpr double kEnlargementStep = 1.1;  // by 10 %
constexpr double kMostEnlargement = 2.0;  // largest area side relative to the first

Error NoRoom(const std::string& why) {
  return InvalidInput("no-room-to-spawn: " + why);
}

// To the millimetre: an enlarged area has long numbers.
std::string AreaText(const Rectangle& area) {
  const auto corner = [](const Vec2& point) {
    return PointText(std::round(point.x() * 1000.0) / 1000.0, std::round(point.y() * 1000.0) / 1000.0);
  };
  return corner(area.min) + " to " + corner(area.max) + " m";
}

// What makes the request senseless, if anything.
std::optional<Error> Refusal(const SpawnRequest& request) {
  if (request.count < 0 || request.count > kMaxRobots) {
    return NoRoom(std::to_string(request.count) + " robots; want 0 to " + std::to_string(kMaxRobots));
  }
  if (!(request.area.min.allFinite() && request.area.max.allFinite() &&
        (request.area.min.array() <= request.area.max.array()).all())) {
    return NoRoom("the area " + AreaText(request.area) + " must go from its least to its greatest corner");
  }
  if (!(request.robot_radius > 0.0 && std::isfinite(request.robot_radius))) {
    return NoRoom("robot radius " + NumberText(request.robot_radius) + " m; want a positive one");
  }
  return std::nullopt;
}

class Spawner {
 public:
  Spawner(const SpawnRequest& request, const OccupancyGrid& grid, RandomStream& random)
      : request_(request),
        grid_(grid),
        random_(random),
        reachable_(grid.Reachable(grid.CellAt(request.start))),
        center_((request.area.min + request.area.max) / 2.0),
        taken_(request.occupied) {
    FindBounds();
    Enlarge(1.0);
  }

  bool AnythingReachable() const { return (bounds_.min.array() < bounds_.max.array()).all(); }

  std::optional<Pose> PlaceNext() {
    while (true) {
      for (int i = 0; i < kTriesPerRobot; ++i) {
        const Vec2 point = Draw();
        if (!Fits(point)) continue;
        taken_.push_back(point);
        // 2 pi - 2 pi u lies in (0, 2 pi], and so the heading in (-pi, pi].
        return Pose{point, kPi - 2.0 * kPi * random_.Uniform()};
      }
      const double next = enlargement_ * kEnlargementStep;
      if (next > kMostEnlargement) return std::nullopt;
      Enlarge(next);
    }
  }

  const Rectangle& area() const { return area_; }

 private:
  // The smallest rectangle around all reachable cells; without area when there is none.
  void FindBounds() {
    Cell first = {grid_.columns(), grid_.rows()};
    Cell last = {-1, -1};
    for (int row = 0; row < grid_.rows(); ++row) {
      for (int column = 0; column < grid_.columns(); ++column) {
        if (reachable_[grid_.Index({column, row})] == 0) continue;
        first = {std::min(first.column, column), std::min(first.row, row)};
        last = {std::max(last.column, column), std::max(last.row, row)};
      }
    }
    if (last.row < 0) return;
    const Vec2 half = Vec2::Constant(grid_.cell_size() / 2.0);
    bounds_ = {grid_.CenterOf(first) - half, grid_.CenterOf(last) + half};
  }

  void Enlarge(double factor) {
    enlargement_ = factor;
    const Vec2 half = (request_.area.max - request_.area.min) / 2.0 * factor;
    area_ = {center_ - half, center_ + half};
    disc_radius_ = half.minCoeff();
    // Clipping throws no candidate away that could have fitted, it only saves tries.
    const Vec2 min = area_.min.cwiseMax(bounds_.min);
    const Vec2 max = area_.max.cwiseMin(bounds_.max);
    clipped_ = (min.array() <= max.array()).all() ? Rectangle{min, max} : area_;
  }

  Vec2 Draw() {
    if (request_.disc) {
      const double radius = disc_radius_ * std::sqrt(random_.Uniform());
      return center_ + radius * UnitVector(2.0 * kPi * random_.Uniform());
    }
    const double x = random_.Uniform(clipped_.min.x(), clipped_.max.x());
    return {x, random_.Uniform(clipped_.min.y(), clipped_.max.y())};
  }

  bool Fits(const Vec2& point) const {
    const Cell cell = grid_.CellAt(point);
    if (!grid_.InGrid(cell) || reachable_[grid_.Index(cell)] == 0) return false;
    // A cell is judged by its centre; near the cell's edge a body could still touch an obstacle.
    if (grid_.Clearance(point) < request_.robot_radius + kGap) return false;
    const double least = 2.0 * request_.robot_radius + kGap;
    return std::none_of(taken_.begin(), taken_.end(),
                        [&](const Vec2& other) { return (other - point).squaredNorm() < least * least; });
  }

  const SpawnRequest& request_;
  const OccupancyGrid& grid_;
  RandomStream& random_;
  std::vector<std::uint8_t> reachable_;
  Rectangle bounds_;
  Vec2 center_;
  double enlargement_ = 1.0;
  Rectangle area_;
  Rectangle clipped_;
  double disc_radius_ = 0.0;
  std::vector<Vec2> taken_;
};

}  // namespace

Result<std::vector<Pose>> Spawn(const SpawnRequest& request, const OccupancyGrid& grid,
                                RandomStream& random) {
  if (std::optional<Error> refusal = Refusal(request)) return *refusal;
  Spawner spawner(request, grid, random);
  if (!spawner.AnythingReachable()) {
    return NoRoom("the start " + PointText(request.start.x(), request.start.y()) +
                  " does not lie in a free cell of the arena");
  }
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(request.count));
  for (int i = 0; i < request.count; ++i) {
    const std::optional<Pose> pose = spawner.PlaceNext();
    if (!pose) {
      return NoRoom("only " + std::to_string(i) + " of " + std::to_string(request.count) +
                    " robots fit into the reachable part of " + (request.disc ? "the disc in " : "") +
                    AreaText(spawner.area()) + ", the enlarged spawn area");
    }
    poses.push_back(*pose);
  }
  return poses;
}

Result<std::vector<Pose>> Spawn(const SpawnRequest& request, const Arena& arena, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kSpawn);
  const OccupancyGrid grid(arena, OccupancyGrid::kDefaultInflation);
  return Spawn(request, grid, random);
}

}  // namespace gauntlet::sim
