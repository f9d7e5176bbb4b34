#include "sim/geometry/directions.h"

#include <cmath>

#include "sim/geometry/series.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {

Directions::Lanes Directions::LanesHere() {
  static const Lanes lanes = __builtin_cpu_supports("avx2") ? Lanes::kFour : Lanes::kTwo;
  return lanes;
}

void Directions::MakeRoom(std::size_t places) {
  blocks_.resize(places / kBlock + 1);
  places_.resize(kBlock * blocks_.size(), Vec2::UnitX());
}

void Directions::WorkOut(std::size_t count) {
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  if (lanes_ == Lanes::kFour ? WorkOutByFour(blocks) : WorkOutByTwo(blocks)) return;
  for (std::size_t i = 0; i < kBlock * blocks; ++i) {
    Block& block = blocks_[i / kBlock];
    const double angle = AngleOf(places_[i]);
    const SinCos both = SineCosine(angle);
    block.angle[i % kBlock] = angle;
    block.sine[i % kBlock] = both.sin;
    block.cosine[i % kBlock] = both.cos;
  }
}

// Atan2 and SineCosine step by step, with choices that are made for all of a block at once. (Compiled without
// -ftrapping-math, which lets GCC do so.)
[[gnu::always_inline]] inline bool Directions::WorkOutBlocks(std::size_t count) {
  constexpr auto& kBase = series::kArctangentOfQuarters;
  std::array<double, kBlock> extreme{};
  const Vec2* place = places_.data();
  for (Block& block : std::span(blocks_).first(count)) {
    std::array<double, kBlock> x;
    std::array<double, kBlock> y;
    for (std::size_t i = 0; i < kBlock; ++i) {
      x[i] = place[i].x();
      y[i] = place[i].y();
    }
    place += kBlock;
    for (std::size_t i = 0; i < kBlock; ++i) {
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
      angle = y[i] < 0.0 ? below : angle;
      block.angle[i] = angle;

      const series::Reduced reduced = series::ReduceToOctant(angle);
      const double s = series::Sine(reduced.remainder);
      const double k = series::Cosine(reduced.remainder);
      const double quadrant = reduced.quadrant;  // -2 to 2
      const bool odd = std::fabs(quadrant) == 1.0;
      block.sine[i] = (odd ? k : s) * (std::fabs(quadrant - 0.5) < 1.0 ? 1.0 : -1.0);
      block.cosine[i] = (odd ? s : k) * (std::fabs(quadrant + 0.5) < 1.0 ? 1.0 : -1.0);
    }
  }
  return extreme[0] + extreme[1] + extreme[2] + extreme[3] == 0.0;
}

bool Directions::WorkOutByTwo(std::size_t count) {
  return WorkOutBlocks(count);
}

[[gnu::target("avx2")]] bool Directions::WorkOutByFour(std::size_t count) {
  return WorkOutBlocks(count);
}

}  // namespace gauntlet::sim
