#include <argos3/core/utility/datatypes/byte_array.h>

#include <algorithm>
#include <cmath>

namespace argos {
namespace {

constexpr double kMantissaScale = 9223372036854775806.0;  // 2^63 - 2

}  // namespace

std::size_t CByteArray::Checked(std::size_t index) const {
  if (index >= Size()) {
    throw CARGoSException("Byte " + std::to_string(index) + " of an array of " + std::to_string(Size()));
  }
  return index;
}

CByteArray* CByteArray::operator()(std::size_t start, SInt64 end) const {
  const std::size_t stop = end < 0 ? Size() : static_cast<std::size_t>(end);
  if (start > stop || stop > Size()) {
    throw CARGoSException("Bytes " + std::to_string(start) + " to " + std::to_string(stop) +
                          " of an array of " + std::to_string(Size()));
  }
  return new CByteArray(bytes_.data() + start, stop - start);
}

CByteArray& CByteArray::AddBuffer(const UInt8* bytes, std::size_t size) {
  bytes_.insert(bytes_.end(), bytes, bytes + size);
  return *this;
}

CByteArray& CByteArray::FetchBuffer(UInt8* bytes, std::size_t size) {
  if (size > Size()) {
    throw CARGoSException("An array of " + std::to_string(Size()) + " bytes has no " + std::to_string(size) +
                          " to take");
  }
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(size);
  std::copy(bytes_.begin(), end, bytes);
  bytes_.erase(bytes_.begin(), end);
  return *this;
}

void CByteArray::AddInteger(UInt64 value, std::size_t bytes) {
  for (std::size_t i = bytes; i-- > 0;) bytes_.push_back(static_cast<UInt8>(value >> (8 * i)));
}

UInt64 CByteArray::TakeInteger(std::size_t bytes) {
  UInt8 taken[sizeof(UInt64)];
  FetchBuffer(taken, bytes);
  UInt64 value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | taken[i];
  return value;
}

CByteArray& CByteArray::operator<<(double value) {
  int exponent = 0;
  const double share = std::frexp(value, &exponent);
  SInt64 mantissa = 0;
  if (share != 0.0) {
    mantissa = static_cast<SInt64>((std::fabs(share) - 0.5) * 2.0 * kMantissaScale) + 1;
    if (share < 0.0) mantissa = -mantissa;
  }
  return *this << mantissa << static_cast<SInt32>(exponent);
}

CByteArray& CByteArray::operator>>(double& value) {
  SInt64 mantissa = 0;
  SInt32 exponent = 0;
  *this >> mantissa >> exponent;
  if (mantissa == 0) {
    value = 0.0;
    return *this;
  }
  const double share = static_cast<double>(std::abs(mantissa) - 1) / kMantissaScale / 2.0 + 0.5;
  value = std::ldexp(mantissa < 0 ? -share : share, exponent);
  return *this;
}

CByteArray& CByteArray::operator>>(float& value) {
  double wide = 0.0;
  *this >> wide;
  value = static_cast<float>(wide);
  return *this;
}

CByteArray& CByteArray::operator<<(const std::string& text) {
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  bytes_.push_back(0);
  return *this;
}

CByteArray& CByteArray::operator>>(std::string& text) {
  const auto end = std::find(bytes_.begin(), bytes_.end(), 0);
  if (end == bytes_.end()) throw CARGoSException("A byte array holds no text that ends");
  text.assign(bytes_.begin(), end);
  bytes_.erase(bytes_.begin(), end + 1);
  return *this;
}

CByteArray& CByteArray::operator<<(const CByteArray& other) {
  return AddBuffer(other.bytes_.data(), other.Size());
}

std::ostream& operator<<(std::ostream& stream, const CByteArray& array) {
  for (std::size_t i = 0; i < array.Size(); ++i) stream << (i > 0 ? " " : "") << array[i];
  return stream;
}

}  // namespace argos
