// A behaviour's parameter as a key that people set.
#pragma once

#include <cstdint>
#include <string>

#include "base/key.h"
#include "controllers/parameters.h"

namespace gauntlet::controllers {

inline bool IsFlag(const ParameterInfo& info) {
  return info.unit == "bool";
}

// The parameter's number in the type of its key.
inline KeyValue KeyValueOf(const ParameterInfo& info, double value) {
  if (IsFlag(info)) return value != 0.0;
  if (info.integer) return static_cast<std::int64_t>(value);
  return value;
}

// The key `beginning` and the parameter's name.
inline KeyInfo KeyInfoOf(const std::string& beginning, const ParameterInfo& info) {
  KeyInfo key;
  key.path = beginning + std::string(info.name);
  key.type = IsFlag(info) ? KeyType::kFlag : info.integer ? KeyType::kInteger : KeyType::kNumber;
  key.unit = IsFlag(info) ? "" : info.unit;
  key.min = info.min;
  key.max = info.max;
  key.description = info.description;
  key.default_value = KeyValueOf(info, info.default_value);
  return key;
}

}  // namespace gauntlet::controllers
