// What a plug-in brings, as a worker tells it to a master, which never loads one itself.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "controllers/behaviour.h"

namespace gauntlet::controllers {

// The largest library that is taken.
inline constexpr std::size_t kMaxPluginBytes = std::size_t{256} << 20;

struct PluginRows {
  std::vector<ControllerInfo> controllers = {};
  std::vector<ScenarioInfo> scenarios = {};
};

inline constexpr int kRowsFormat = 2;
// Their data as JSON (row_json.h), for ReadRows of row_checks.h.
std::string WriteRows(const PluginRows& rows);

}  // namespace gauntlet::controllers
