// Checksums of stored rows: they find bits that have turned and values that were changed, and are no defence
// against somebody who computes them anew.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/hash.h"

namespace gauntlet {

// Stored: do not change.
class RowHash {
 public:
  void Add(std::integral auto number) { hash_.AddUint64(static_cast<std::uint64_t>(number)); }
  void Add(std::string_view bytes) {
    hash_.AddUint64(bytes.size());
    while (!bytes.empty()) {
      std::uint64_t word = 0;
      const std::size_t size = bytes.size() < sizeof word ? bytes.size() : sizeof word;
      std::memcpy(&word, bytes.data(), size);
      hash_.AddUint64(word);
      bytes.remove_prefix(size);
    }
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  WordHash64 hash_;
};

// Of a row's values, numbers and bytes, in their order.
template <typename... Values>
std::uint64_t RowChecksum(const Values&... values) {
  RowHash hash;
  (hash.Add(values), ...);
  return hash.value();
}

}  // namespace gauntlet
