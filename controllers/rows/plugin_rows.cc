#include "controllers/rows/plugin_rows.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "controllers/rows/row_json.h"

namespace gauntlet::controllers {

std::string WriteRows(const PluginRows& rows) {
  using Json = nlohmann::ordered_json;
  Json controllers = Json::array();
  for (const ControllerInfo& row : rows.controllers) controllers.push_back(JsonOf(row));
  Json scenarios = Json::array();
  for (const ScenarioInfo& row : rows.scenarios) scenarios.push_back(JsonOf(row));
  const Json json = {
      {"format", kRowsFormat}, {"controllers", std::move(controllers)}, {"scenarios", std::move(scenarios)}};
  return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gauntlet::controllers
