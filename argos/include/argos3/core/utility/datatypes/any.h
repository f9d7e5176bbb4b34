// A box for a value of any type, which any_cast takes out as exactly that type.
#pragma once

#include <any>
#include <type_traits>

#include <argos3/core/utility/configuration/argos_exception.h>

namespace argos {

class CAny {
 public:
  CAny() = default;
  template <typename T>
  requires(!std::is_same_v<std::decay_t<T>, CAny>) CAny(const T& value) : value_(value) {}

  bool IsEmpty() const { return !value_.has_value(); }
  template <typename T>
  T* As() {
    return std::any_cast<T>(&value_);
  }
  template <typename T>
  const T* As() const {
    return std::any_cast<T>(&value_);
  }

 private:
  std::any value_;
};

// Null when something else is in it.
template <typename T>
T* any_cast(CAny* box) {
  return box->As<T>();
}
// Throws when something else is in it.
template <typename T>
T any_cast(CAny& box) {
  auto* const value = box.As<std::remove_cv_t<std::remove_reference_t<T>>>();
  if (value == nullptr) throw CARGoSException("any_cast: the value has another type");
  return *value;
}
template <typename T>
T any_cast(const CAny& box) {
  auto* const value = box.As<std::remove_cv_t<std::remove_reference_t<T>>>();
  if (value == nullptr) throw CARGoSException("any_cast: the value has another type");
  return *value;
}

}  // namespace argos
