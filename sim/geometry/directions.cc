#include "sim/geometry/directions.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/geometry/series.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {

Directions::Lanes Directions::LanesHere() {
  static const Lanes lanes = __builtin_cpu_supports("avx2") ? Lanes::kFour : Lanes::kTwo;
  return lanes;
}

inline Vec2 Directions::Places::Position(std::size_t i) const {
  std::array<double, 2> coordinates;
  std::memcpy(coordinates.data(), position + i * step, sizeof coordinates);
  return {coordinates[0], coordinates[1]};
}

inline double Directions::Places::Range(std::size_t i) const {
  double length;
  std::memcpy(&length, range + i * step, sizeof length);
  return length;
}

namespace {

// So near or far that a step of an arctangent may overflow or underflow.
bool Extreme(const Vec2& position) {
  const double larger = position.cwiseAbs().maxCoeff();
  return !(larger > series::kShortest && larger < series::kLongest);
}

}  // namespace

void Directions::WorkOut(const Places& places) {
  if (places.count > kBlock * blocks_.size()) MakeRoom(2 * places.count);
  if (lanes_ == Lanes::kFour ? WorkOutByFour(places) : WorkOutByTwo(places)) return;
  for (std::size_t i = 0; i < places.count; ++i) {
    const Vec2 position = places.Position(i);
    const double angle = AngleOf(position);
    const SinCos both = SineCosine(angle);
    const bool extreme = Extreme(position);
    Block& block = blocks_[i / kBlock];
    block.angle[i % kBlock] = angle;
    block.sine[i % kBlock] = extreme ? both.sin : position.y() / places.Range(i);
    block.cosine[i % kBlock] = extreme ? both.cos : position.x() / places.Range(i);
  }
}

// Atan2 step by step, with choices that are made for all of a block at once. (Compiled without
// -ftrapping-math, which lets GCC do so.)
[[gnu::always_inline]] inline bool Directions::WorkOutBlocks(const Places& places) {
  constexpr auto& kBase = series::kArctangentOfQuarters;
  std::array<double, kBlock> extreme{};
  for (std::size_t first = 0; first < places.count; first += kBlock) {
    Block& block = blocks_[first / kBlock];
    std::array<double, kBlock> x;
    std::array<double, kBlock> y;
    std::array<double, kBlock> range;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::size_t place = std::min(first + i, places.count - 1);
      x[i] = places.Position(place).x();
      y[i] = places.Position(place).y();
      range[i] = places.Range(place);
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
      block.cosine[i] = x[i] / range[i];
      block.sine[i] = y[i] / range[i];

      const double opposite = std::fabs(y[i]);
      const double adjacent = std::fabs(x[i]);
      const double larger = opposite > adjacent ? opposite : adjacent;
      const double smaller = adjacent < opposite ? adjacent : opposite;
      extreme[i] += larger > series::kShortest ? 0.0 : 1.0;
      extreme[i] += larger < series::kLongest ? 0.0 : 1.0;
      const double eighths = 8.0 * smaller;
      double c = eighths > larger ? 0.25 : 0.0;
      double base = eighths > larger ? kBase[1] : kBase[0];
      c = eighths > 3.0 * larger ? 0.5 : c;
      base = eighths > 3.0 * larger ? kBase[2] : base;
      c = eighths > 5.0 * larger ? 0.75 : c;
      base = eighths > 5.0 * larger ? kBase[3] : base;
      c = eighths > 7.0 * larger ? 1.0 : c;
      base = eighths > 7.0 * larger ? kBase[4] : base;
      double angle = base + series::Arctangent((smaller - c * larger) / (larger + c * smaller));
      angle = opposite > adjacent ? 0.5 * kPi - angle : angle;
      angle = x[i] < 0.0 ? kPi - angle : angle;
      const double below = angle < kPi ? -angle : angle;  // -pi is the same direction as pi
      block.angle[i] = y[i] < 0.0 ? below : angle;
    }
  }
  return extreme[0] + extreme[1] + extreme[2] + extreme[3] == 0.0;
}

bool Directions::WorkOutByTwo(const Places& places) {
  return WorkOutBlocks(places);
}

[[gnu::target("avx2")]] bool Directions::WorkOutByFour(const Places& places) {
  return WorkOutBlocks(places);
}

}  // namespace gauntlet::sim
