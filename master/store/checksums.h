// Checksums of stored rows: they find bits that have turned and values that were changed, and are no defence
// against somebody who computes them anew.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/hash.h"

namespace gauntlet {

// Of a row's values, in their order. Stored: do not change.
class RowChecksum {
 public:
  RowChecksum& Number(std::uint64_t value) {
    hash_.AddUint64(value);
    return *this;
  }
  RowChecksum& Bytes(std::string_view bytes) {
    hash_.AddUint64(bytes.size());
    while (!bytes.empty()) {
      std::uint64_t word = 0;
      const std::size_t size = bytes.size() < sizeof word ? bytes.size() : sizeof word;
      std::memcpy(&word, bytes.data(), size);
      hash_.AddUint64(word);
      bytes.remove_prefix(size);
    }
    return *this;
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  WordHash64 hash_;
};

}  // namespace gauntlet
