// The directions of many places at once, in a fraction of the time that one after the other takes: several
// are worked out by each instruction. An angle is to the last bit that of AngleOf; its sine and cosine are
// the place divided by its distance, which needs no angle first and is nearer to them than those of the
// rounded angle.
#pragma once

#include <array>
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
  double Angle(std::size_t i) const { return BlockOf(i).angle[i % kBlock]; }  // rad in (-pi, pi]
  double Sine(std::size_t i) const { return BlockOf(i).sine[i % kBlock]; }
  double Cosine(std::size_t i) const { return BlockOf(i).cosine[i % kBlock]; }

 private:
  static constexpr std::size_t kBlock = 4;

  struct Block {
    alignas(kBlock * sizeof(double)) std::array<double, kBlock> angle{};
    std::array<double, kBlock> sine{};
    std::array<double, kBlock> cosine{};
  };

  // Where the positions and ranges lie in memory, the next one `step` bytes further.
  struct Places {
    const std::byte* position = nullptr;
    const std::byte* range = nullptr;
    std::size_t step = 0;
    std::size_t count = 0;

    Vec2 Position(std::size_t i) const;
    double Range(std::size_t i) const;
  };

  const Block& BlockOf(std::size_t i) const { return blocks_[i / kBlock]; }
  void MakeRoom(std::size_t places) { blocks_.resize(places / kBlock + 1); }
  void WorkOut(const Places& places);
  // False when a place is so near or far that a step overflows or underflows.
  bool WorkOutBlocks(const Places& places);
  bool WorkOutByTwo(const Places& places);
  bool WorkOutByFour(const Places& places);

  Lanes lanes_;
  std::vector<Block> blocks_;
};

}  // namespace gauntlet::sim
