// The table of an experiment that defines a scenario: [generic] and the lists in it, [[generic.light]] and
// on.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {

// What it may hold, for who lists it; of a list its first element, "generic.light.1.x". Formulas are texts.
std::vector<KeyInfo> DefinitionKeys();

// Whether the path is in that table.
bool InDefinition(std::string_view path);

// What these of the assignments define, as the text of sim::RunSpec::definition; the later of one path win.
// Error: begins with the assignment's place, or with `file_name` when something is missing.
Result<std::string> ReadDefinition(std::span<const Assignment> assignments, const std::string& file_name);

// The table that ReadDefinition reads that text from; "" of none.
std::string WriteDefinition(const std::string& definition);

// The same as keys and values, as they are typed behind --set.
std::vector<std::pair<std::string, std::string>> DefinitionSettings(const std::string& definition);

}  // namespace gauntlet
