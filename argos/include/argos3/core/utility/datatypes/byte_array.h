// Bytes that values are appended to and taken from. Integers are in network byte order, long ones have 8
// bytes.
#pragma once

#include <cstddef>
#include <iostream>
#include <string>
#include <type_traits>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CByteArray {
 public:
  CByteArray() = default;
  explicit CByteArray(std::size_t size, UInt8 value = 0) : bytes_(size, value) {}
  CByteArray(const UInt8* bytes, std::size_t size) : bytes_(bytes, bytes + size) {}

  std::size_t Size() const { return bytes_.size(); }
  bool Empty() const { return bytes_.empty(); }
  void Resize(std::size_t size, UInt8 value = 0) { bytes_.resize(size, value); }
  void Clear() { bytes_.clear(); }
  void Zero() { bytes_.assign(bytes_.size(), 0); }
  void Swap(CByteArray& other) { bytes_.swap(other.bytes_); }
  UInt8* ToCArray() { return Empty() ? nullptr : bytes_.data(); }
  const UInt8* ToCArray() const { return Empty() ? nullptr : bytes_.data(); }

  // Throws when there is no such byte.
  UInt8& operator[](std::size_t index) { return bytes_[Checked(index)]; }
  const UInt8& operator[](std::size_t index) const { return bytes_[Checked(index)]; }
  // The bytes from `start` to before `end`, -1 meaning all that follow, in an array of its own: the caller's
  // to delete.
  CByteArray* operator()(std::size_t start, SInt64 end = -1) const;
  bool operator==(const CByteArray& other) const { return bytes_ == other.bytes_; }

  CByteArray& AddBuffer(const UInt8* bytes, std::size_t size);
  // These take from the front, and throw when less is left.
  CByteArray& FetchBuffer(UInt8* bytes, std::size_t size);
  template <typename T>
  T PopFront() {
    T value{};
    *this >> value;
    return value;
  }

  // bool, char and the types of characters are promoted to an SInt32, since ARGoS has no overload for them.
  template <typename T>
  requires std::is_integral_v<T> CByteArray& operator<<(T value) {
    constexpr bool kPromoted = std::is_same_v<T, bool> || std::is_same_v<T, char> ||
                               std::is_same_v<T, wchar_t> || std::is_same_v<T, char16_t> ||
                               std::is_same_v<T, char32_t>;
    using Added = std::conditional_t<kPromoted, decltype(+value), T>;
    AddInteger(static_cast<UInt64>(static_cast<Added>(value)), sizeof(Added));
    return *this;
  }
  template <typename T>
  requires std::is_integral_v<T> CByteArray& operator>>(T& value) {
    value = static_cast<T>(TakeInteger(sizeof(T)));
    return *this;
  }
  // 12 bytes: an SInt64 and an SInt32 that say both mantissa and exponent.
  CByteArray& operator<<(double value);
  CByteArray& operator>>(double& value);
  CByteArray& operator<<(float value) { return *this << static_cast<double>(value); }
  CByteArray& operator>>(float& value);
  // Ends with a zero byte.
  CByteArray& operator<<(const std::string& text);
  CByteArray& operator>>(std::string& text);
  CByteArray& operator<<(const CByteArray& other);

  friend std::ostream& operator<<(std::ostream& stream, const CByteArray& array);

 private:
  std::size_t Checked(std::size_t index) const;
  void AddInteger(UInt64 value, std::size_t bytes);
  UInt64 TakeInteger(std::size_t bytes);

  std::vector<UInt8> bytes_;
};

}  // namespace argos
