// Definitions of commands for tests.
#pragma once

#include <nlohmann/json.hpp>

#include "controllers/command/definition.h"

namespace gauntlet::controllers::command {

inline nlohmann::json SmallTable() {
  return {{"run", {"sim", "{case}"}}, {"metrics", {"items"}}, {"fitness", "items"}, {"failure", "items < 5"}};
}

// Of SmallTable with these keys besides; aborts with the complaint about one that is wrong.
inline Definition DefinitionWith(const nlohmann::json& more = nlohmann::json::object()) {
  nlohmann::json table = SmallTable();
  if (more.is_object()) table.update(more);
  ReadDefinition read = Read(table);
  GAUNTLET_CHECK(!read.complaint, read.complaint->what);
  return std::move(read.definition);
}

}  // namespace gauntlet::controllers::command
