// The directions of many places at once, in a fraction of the time that one after the other takes: several
// are worked out by each instruction. An angle is to the last bit that of AngleOf; its sine and cosine are
// the place divided by its distance, which needs no angle first and is nearer to them than those of the
// rounded angle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

class Directions {
 public:
  // By how many an instruction works out; changes the time, never a bit.
  enum class Lanes { kTwo, kFour };
  static Lanes LanesHere();  // four where the processor has AVX2

  // Allocates nothing for up to `room` places.
  explicit Directions(std::size_t room, Lanes lanes = LanesHere()) : lanes_(lanes) { MakeRoom(room); }

  // Of the members `position` of what was seen, any finite ones, whose length is `range`. Of no length: angle
  // and sine 0.
  template <typename Seen>
  void WorkOut(std::span<const Seen> all) {
    if (all.empty()) return;
    WorkOut({.position = reinterpret_cast<const std::byte*>(&all.front().position),
             .range = reinterpret_cast<const std::byte*>(&all.front().range),
             .step = sizeof(Seen),
             .count = all.size()});
  }

  // Of one of those.
  double Angle(std::size_t i) const { return angle_[i]; }  // rad in (-pi, pi]
  double Sine(std::size_t i) const { return sine_[i]; }
  double Cosine(std::size_t i) const { return cosine_[i]; }

 private:
  // Where the positions and ranges lie in memory, the next one `step` bytes further.
  struct Places {
    const std::byte* position = nullptr;
    const std::byte* range = nullptr;
    std::size_t step = 0;
    std::size_t count = 0;

    Vec2 Position(std::size_t i) const;
    double Range(std::size_t i) const;
  };

  void MakeRoom(std::size_t places);
  void WorkOut(const Places& places);
  // Of the first `count` places, a whole number of fours.
  void StepByTwo(std::size_t count);
  void StepByFour(std::size_t count);

  Lanes lanes_;
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> range_;
  std::vector<double> angle_;
  std::vector<double> sine_;
  std::vector<double> cosine_;
  std::vector<double> larger_;  // of the two coordinates
};

}  // namespace gauntlet::sim
