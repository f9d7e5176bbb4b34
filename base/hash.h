// FNV-1a, 64 bit: the hash of run results, specs and stored records
// (http://www.isthe.com/chongo/tech/comp/fnv/). It detects differences between honest runs; it is no defence
// against forgery.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/double_bits.h"

namespace gauntlet {

class Fnv1a64 {
 public:
  void AddByte(std::uint8_t byte) {
    state_ ^= byte;
    state_ *= 0x100000001b3ULL;
  }
  // Least significant byte first, on any machine.
  void AddUint64(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) AddByte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  // The bits of the double; -0.0 and 0.0 differ on purpose.
  void AddDouble(double value) { AddUint64(BitsOf(value)); }
  void AddBytes(std::string_view bytes) {
    for (const char c : bytes) AddByte(static_cast<std::uint8_t>(c));
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

// A hash of many words: one multiplication for each, where FNV-1a takes eight one after the other (3 % of a
// run, measured). Streams that differ in one word only always differ in their hashes.
class WordHash64 {
 public:
  void AddUint64(std::uint64_t value) {
    state_ = (state_ ^ value) * 0x9e3779b97f4a7c15ULL;  // 2^64 / the golden ratio, odd
    state_ ^= state_ >> 32;
  }
  // The bits of the double; -0.0 and 0.0 differ on purpose.
  void AddDouble(double value) { AddUint64(BitsOf(value)); }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace gauntlet
