// Sets of small numbers in the bits of a word.
#pragma once

#include <bit>
#include <cstddef>

namespace gauntlet {

// Calls visit(i) for every bit i of `bits` that is 1, in ascending order.
template <std::unsigned_integral Bits, typename Visit>
void ForEachBit(Bits bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace gauntlet
