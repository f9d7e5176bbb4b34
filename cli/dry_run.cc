#include "cli/dry_run.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "master/campaign/forecast.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

// "13 MB", of decimal units.
std::string FormatBytes(double bytes) {
  const char* unit = "kB";
  double value = bytes / 1e3;
  for (const char* larger : {"MB", "GB", "TB"}) {
    if (value < 999.5) break;
    value /= 1e3;
    unit = larger;
  }
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, unit);
}

std::string ForecastJson(const Forecast& forecast, const std::vector<SearchPlan>& searches, int workers,
                         const FailureTally& without_obstacles) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SearchPlan& search : searches)
    list.push_back({{"settings", search.settings}, {"seed", fmt::format("{}", search.experiment.seed)}});
  nlohmann::ordered_json json({{"experiment", searches.front().experiment.name},
                               {"searches", std::move(list)},
                               {"runs", forecast.runs},
                               {"cases", forecast.cases},
                               {"cases_exact", forecast.cases_exact},
                               {"workers", workers},
                               {"seconds", forecast.Seconds(workers)},
                               {"measured_runs", forecast.measured_runs},
                               {"measured_without_result", forecast.measured_without_result},
                               {"cpu_seconds_per_run", forecast.seconds_per_run},
                               {"bytes", std::llround(forecast.bytes)}});
  if (without_obstacles.runs() > 0)
    json["without_obstacles"] = {without_obstacles.failures, without_obstacles.runs()};
  return JsonText(json);
}

std::string ForecastText(const Forecast& forecast, const std::vector<SearchPlan>& searches, int workers,
                         const FailureTally& without_obstacles) {
  Table table({"", ""});
  table.AddRow({"searches", FormatCount(searches.size())});
  table.AddRow({"runs", FormatCount(forecast.runs)});
  table.AddRow({"test cases", forecast.cases_exact
                                  ? FormatCount(forecast.cases)
                                  : fmt::format("at most {} different", FormatCount(forecast.cases))});
  table.AddRow({"time", fmt::format("about {} with {} ({} of the first runs took {:.3g} ms each here; "
                                    "later ones may differ)",
                                    FormatDuration(forecast.Seconds(workers)), Counted(workers, "worker"),
                                    forecast.measured_runs, 1e3 * forecast.seconds_per_run)});
  if (forecast.measured_without_result > 0) {
    table.AddRow({"no result", fmt::format("{} of those {} runs: {}", forecast.measured_without_result,
                                           forecast.measured_runs, Printable(forecast.why_without_result))});
  }
  if (const int runs = without_obstacles.runs(); runs > 0) {
    const int failures = without_obstacles.failures;
    table.AddRow(
        {"no obstacles", fmt::format("{} of {} runs fail{}", failures, runs,
                                     2 * failures >= runs ? ": what fails in a search will say little"
                                                            " about obstacles"
                                                          : "")});
  }
  table.AddRow({"disk", "about " + FormatBytes(forecast.bytes)});
  return fmt::format("{}: a dry run, nothing was made\n\n{}", Printable(searches.front().experiment.name),
                     table.ToText());
}

}  // namespace

Result<ExitCode> PrintDryRun(CommandContext& context, const CampaignRun& campaign,
                             const std::vector<SearchPlan>& searches, const FailureTally& without_obstacles) {
  TRY(const Forecast forecast, MakeForecast(searches));
  const int workers = campaign.MostWorkers();
  context.out << (campaign.serving.json ? ForecastJson(forecast, searches, workers, without_obstacles)
                                        : ForecastText(forecast, searches, workers, without_obstacles))
              << std::flush;
  return kExitDone;
}

}  // namespace gauntlet
