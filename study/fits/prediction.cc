#include "study/fits/prediction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/sample.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/system/atomic_file.h"
#include "controllers/registry.h"
#include "master/campaign/stored_campaign.h"
#include "study/sets/csv_column.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

constexpr const char* kSettingsName = "settings";

// The mean of a metric over a subset's runs; nothing is added where none could be measured.
Status AddMean(const StoredCampaign& campaign, const std::string& dir, const Subset& subset,
               const std::string& metric, const std::string& name, Figures& figures) {
  double sum = 0.0;
  std::size_t measured = 0;
  const auto add = [&](const SubsetSearch& search) -> Status {
    TRY(const auto runs, SelectRuns(search, *campaign.view.store, subset, metric));
    for (const SelectedRun& run : runs) {
      if (!run.value || !std::isfinite(*run.value)) continue;
      sum += *run.value;
      ++measured;
    }
    return Ok{};
  };
  TRY(ForEachSearch(campaign.plans, *campaign.view.store, dir, subset, add));
  if (measured > 0) figures[name] = sum / static_cast<double>(measured);
  return Ok{};
}

}  // namespace

std::vector<std::vector<std::string>> DrawSettings(const FitResult& fit, std::size_t count) {
  sim::RandomStream random(fit.experiment.seed, sim::StreamPurpose::kStatistics, 0);
  std::vector<std::vector<std::string>> drawn;
  while (drawn.size() < count && !fit.draws.empty()) {
    const SettingsPoint& place = fit.draws[random.Below(static_cast<std::uint32_t>(fit.draws.size()))];
    std::vector<std::string>& sets = drawn.emplace_back();
    for (std::size_t i = 0; i < place.size(); ++i) {
      const VariedKey& key = fit.plan.varied[i];
      sets.push_back(fmt::format("{}={}", key.key.path, ToSet(key.ValueAt(place[i]))));
    }
  }
  return drawn;
}

Result<Figures> FiguresOfCampaign(const std::string& dir) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
  Figures figures;
  const Subset all{.kind = Subset::Kind::kAll};
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(campaign.plans.front().experiment);
  std::vector<std::string> metrics = {"fitness", std::string(controllers::kTotalFailure)};
  for (const controllers::MetricInfo& metric : scenario->metrics) {
    if (metric.name.find('*') == std::string::npos) metrics.emplace_back(metric.name);
  }
  for (const std::string& metric : metrics) {
    TRY(AddMean(campaign, dir, all, metric, metric + ", mean of all runs", figures));
  }
  TRY(AddMean(campaign, dir, {}, "fitness", "fitness, mean of the final population", figures));
  return figures;
}

Result<PredictionFile> PredictionFile::Open(const std::string& path) {
  PredictionFile file;
  file.path_ = path;
  const Result<std::string> text = ReadSmallFile(path, std::size_t{64} << 20);
  if (!text && text.error().kind == ErrorKind::kNotFound) return file;
  if (!text) return text.error();
  TRY(const auto lines, ReadCsvLines(*text, path));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string>& cells = lines[i].cells;
    const auto draw = ParseNumber<std::size_t>(cells.at(0));
    const bool next = draw && *draw == file.draws_.size() + 1;
    const bool same = draw && *draw == file.draws_.size() && *draw > 0;
    const auto value = ParseNumber<double>(cells.back());
    const bool is_setting = cells.size() == 3 && cells[1] == kSettingsName;
    if (cells.size() != 3 || (!next && !same) || (!is_setting && !(value && std::isfinite(*value))))
      return Error{ErrorKind::kCorrupt,
                   fmt::format("{}:{}: no line draw,name,value in order", path, lines[i].number)};
    if (next) file.draws_.emplace_back();
    if (is_setting) {
      file.draws_.back().settings.push_back(cells[2]);
    } else {
      file.draws_.back().figures[cells[1]] = *value;
    }
  }
  return file;
}

std::string PredictionFile::Text() const {
  Table table({"draw", "name", "value"});
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    for (const std::string& one : draws_[i].settings) table.AddRow({i + 1, kSettingsName, one});
    for (const auto& [name, value] : draws_[i].figures) table.AddRow({i + 1, name, value});
  }
  return table.ToCsv();
}

Status PredictionFile::Add(const std::vector<std::string>& settings, const Figures& figures) {
  draws_.push_back({settings, figures});
  return WriteFileAtomically(path_, Text(), kReadableByAll);
}

Table PredictionFile::Ranges(std::size_t count) const {
  Table table({{"figure", "figure"},
               {">draws", "draws"},
               {">lowest", "lowest"},
               {">median", "median"},
               {">highest", "highest"},
               {"middle 90 %", "likely"}});
  std::map<std::string, std::vector<double>> values;
  for (std::size_t i = 0; i < std::min(count, draws_.size()); ++i) {
    for (const auto& [name, value] : draws_[i].figures) values[name].push_back(value);
  }
  for (auto& [name, of_draws] : values) {
    std::ranges::sort(of_draws);
    const auto at = [&, &sorted = of_draws](double share) { return analysis::Quantile(sorted, share); };
    table.AddRow({name, of_draws.size(), DecimalCell(of_draws.front(), 4), DecimalCell(at(0.5), 4),
                  DecimalCell(of_draws.back(), 4), IntervalCell(analysis::Interval{at(0.05), at(0.95)})});
  }
  return table;
}

}  // namespace gauntlet
