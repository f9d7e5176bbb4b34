// The canonical encoding that hashes are taken over: integers little-endian in 8 bytes, doubles as their
// bits, strings and lists with a length in front. It never changes with a library's version, as protobuf's
// bytes may.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/double_bits.h"
#include "base/result.h"

namespace gauntlet {

class CanonicalEncoder {
 public:
  void Uint(std::uint64_t value) {
    char bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
    bytes_.append(bytes, sizeof bytes);
  }
  void Int(std::int64_t value) { Uint(static_cast<std::uint64_t>(value)); }
  void Double(double value) { Uint(BitsOf(value)); }
  void Bool(bool value) { Uint(value ? 1 : 0); }
  void String(std::string_view value) {
    Uint(value.size());
    bytes_.append(value);
  }
  // Room for so many more bytes.
  void Reserve(std::size_t bytes) { bytes_.reserve(bytes_.size() + bytes); }
  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads what CanonicalEncoder wrote. After a read past the end every further read gives zero and ok() is
// false.
class CanonicalDecoder {
 public:
  explicit CanonicalDecoder(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t Uint() {
    if (bytes_.size() - position_ < 8) return Fail();
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) {
      value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes_[position_++])) << (8 * i);
    }
    return value;
  }
  std::int64_t Int() { return static_cast<std::int64_t>(Uint()); }
  double Double() { return DoubleOf(Uint()); }
  bool Bool() { return Uint() != 0; }
  std::string String() {
    const std::uint64_t size = Uint();
    if (bytes_.size() - position_ < size) {
      Fail();
      return {};
    }
    std::string value(bytes_.substr(position_, size));
    position_ += size;
    return value;
  }
  bool ok() const { return ok_; }
  bool AtEnd() const { return position_ == bytes_.size(); }

 private:
  std::uint64_t Fail() {
    ok_ = false;
    position_ = bytes_.size();
    return 0;
  }

  std::string_view bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace gauntlet
