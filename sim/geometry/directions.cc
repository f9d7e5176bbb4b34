#include "sim/geometry/directions.h"

#include <algorithm>
#include <array>
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

void Directions::MakeRoom(std::size_t places) {
  for (std::vector<double>* each : {&x_, &y_, &range_, &angle_, &sine_, &cosine_, &larger_})
    each->resize((places + 3) / 4 * 4);
}

void Directions::WorkOut(const Places& places) {
  if (places.count > x_.size()) MakeRoom(2 * places.count);
  const std::size_t count = (places.count + 3) / 4 * 4;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = std::min(i, places.count - 1);
    const Vec2 position = places.Position(place);
    x_[i] = position.x();
    y_[i] = position.y();
    range_[i] = places.Range(place);
  }
  if (lanes_ == Lanes::kFour) {
    StepByFour(count);
  } else {
    StepByTwo(count);
  }
  for (std::size_t i = 0; i < places.count; ++i) {
    if (larger_[i] > series::kShortest && larger_[i] < series::kLongest) continue;
    angle_[i] = AngleOf({x_[i], y_[i]});
    const SinCos both = SineCosine(angle_[i]);
    sine_[i] = both.sin;
    cosine_[i] = both.cos;
  }
}

namespace {

// Atan2 step by step, with choices instead of branches, which compilers make for several places at once.
// (Compiled without -ftrapping-math, which lets GCC do so.)
[[gnu::always_inline]] inline void Steps(std::size_t fours, const double* __restrict x,
                                         const double* __restrict y, const double* __restrict range,
                                         double* __restrict angles, double* __restrict sines,
                                         double* __restrict cosines, double* __restrict larger_ones) {
  constexpr auto& kBase = series::kArctangentOfQuarters;
  for (std::size_t i = 0; i < 4 * fours; ++i) {
    cosines[i] = x[i] / range[i];
    sines[i] = y[i] / range[i];

    const double opposite = std::fabs(y[i]);
    const double adjacent = std::fabs(x[i]);
    const double larger = opposite > adjacent ? opposite : adjacent;
    const double smaller = adjacent < opposite ? adjacent : opposite;
    larger_ones[i] = larger;
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
    angles[i] = y[i] < 0.0 ? below : angle;
  }
}

}  // namespace

void Directions::StepByTwo(std::size_t count) {
  Steps(count / 4, x_.data(), y_.data(), range_.data(), angle_.data(), sine_.data(), cosine_.data(),
        larger_.data());
}

[[gnu::target("avx2")]] void Directions::StepByFour(std::size_t count) {
  Steps(count / 4, x_.data(), y_.data(), range_.data(), angle_.data(), sine_.data(), cosine_.data(),
        larger_.data());
}

}  // namespace gauntlet::sim
