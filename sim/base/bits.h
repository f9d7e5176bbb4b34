// Sets of small numbers in the bits of a word.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace gauntlet {

// Calls visit(i) for every bit i of `bits` that is 1, in ascending order.
template <typename Visit>
void ForEachBit(std::uint32_t bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace gauntlet
