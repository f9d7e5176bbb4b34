// The data that a report's scripts read: one JSON document, embedded in the page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "report/pages/report_page.h"

namespace gauntlet {

// {"served", "campaigns": [{"directory", "runs_done", "failure_types",
//  "case_columns": [{"key", "title", "number"}], "cases": [[...]]}],
//  "replays": {ID: ...}}, campaigns in their order, replays by the ids of their pages. Of pages that are
//  served "cases" is
// null and there are no replays: scripts ask the server for them.
nlohmann::ordered_json ReportDocument(const Report& report);

// A run that plays. Lengths in m, times in s, angles in rad; `poses` in base64, four bytes for each moment of
// `times` and robot: 12 bits for x and 12 for y over the arena between the walls' centre lines, 8 for the
// heading over the whole turn, the lowest bits first. `last` are the poses of the last moment as they are:
// [[x, y, heading], ...].
nlohmann::ordered_json ReplayDocument(const analysis::RunFigure& figure);

}  // namespace gauntlet
