// A double as its 64 bits and back: std::bit_cast, for headers that compilers without it (GCC 10) read too.
#pragma once

#include <cstdint>
#include <cstring>

namespace gauntlet {

inline std::uint64_t BitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline double DoubleOf(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace gauntlet
