// Assignments to keys: a value read as the type of its key, and written back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

// "unknown key 'search.popultion'; did you mean 'search.population'?": the key that could have been meant, by
// its name, its name in another table or the words in it ('camera_drop' of
// noise.omnidirectional_camera.drop); else the keys of its table; else all tables.
std::string UnknownKey(const std::string& path, const std::vector<std::string_view>& known);

// "NAME = VALUE  # what the key means", a line that ReadToml reads.
std::string LineOf(std::string_view name, const KeyInfo& key, const KeyValue& value);

}  // namespace gauntlet
