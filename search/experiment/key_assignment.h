// Assignments to keys: a value read as the type of its key, and written back.
#pragma once

#include <string>

#include "base/key.h"
#include "base/result.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {

// The assignment's value in the type of the key. Error: its place, key and value, and what is allowed.
Result<KeyValue> ValueFor(const KeyInfo& key, const Assignment& assignment);

template <typename Settings>
Status Assign(const SettingsKey<Settings>& key, const Assignment& assignment, Settings& settings) {
  TRY(const KeyValue value, ValueFor(key, assignment));
  key.set(settings, value);
  return Ok{};
}

// "NAME = VALUE  # what the key means", a line that ReadToml reads.
std::string LineOf(std::string_view name, const KeyInfo& key, const KeyValue& value);

}  // namespace gauntlet
