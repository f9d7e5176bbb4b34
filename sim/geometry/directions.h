// The directions of many places at once, to the last bit as AngleOf and SineCosine give them one by one, in a
// fraction of the time: several are worked out by each instruction.
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

  // Of the members `position` of what was seen, any finite ones.
  template <typename Seen>
  void WorkOut(std::span<const Seen> all) {
    if (all.size() > places_.size()) MakeRoom(2 * all.size());
    for (std::size_t i = 0; i < all.size(); ++i) places_[i] = all[i].position;
    WorkOut(all.size());
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

  const Block& BlockOf(std::size_t i) const { return blocks_[i / kBlock]; }
  void MakeRoom(std::size_t places);
  void WorkOut(std::size_t count);
  // The first blocks. False when a place is so near or far that a step overflows or underflows.
  bool WorkOutBlocks(std::size_t count);
  bool WorkOutByTwo(std::size_t count);
  bool WorkOutByFour(std::size_t count);

  Lanes lanes_;
  std::vector<Vec2> places_;
  std::vector<Block> blocks_;
};

}  // namespace gauntlet::sim
