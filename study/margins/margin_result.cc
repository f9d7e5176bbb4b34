#include "study/margins/margin_result.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "master/campaign/stored_campaign.h"
#include "master/campaign/stored_search.h"
#include "proto/json_text.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostLevels = 12;  // that are printed of a key; figure and JSON have all

// In the direction in which failures become more frequent, as a share of the range; infinite beyond it.
struct Withstood {
  double low = 0.0;
  double high = 0.0;
  double estimate = 0.0;
};

Withstood WithstoodBy(const Margin& margin) {
  const MarginEstimate& e = *margin.estimate;
  const MarginStages scale(margin.plan);
  const auto place = [&](double value) { return std::isfinite(value) ? scale.PlaceOf(value) : value; };
  if (!e.falls) return {place(e.low), place(e.high), place(e.estimate)};
  return {1.0 - place(e.high), 1.0 - place(e.low), 1.0 - place(e.estimate)};
}

enum class Side { kCrosses, kAlwaysBelow, kAlwaysAbove, kUnknown };

Side SideOf(const Margin& margin) {
  if (!margin.estimate) return Side::kUnknown;
  const Withstood one = WithstoodBy(margin);
  if (one.high <= 0.0) return Side::kAlwaysAbove;
  if (one.low >= 1.0) return Side::kAlwaysBelow;
  return std::isfinite(one.low) && std::isfinite(one.high) ? Side::kCrosses : Side::kUnknown;
}

// "0.1 to 0.15"; of an end that may lie outside "up to 0.15", "0.1 or more".
std::string IntervalText(const MarginEstimate& e) {
  const bool low = std::isfinite(e.low);
  const bool high = std::isfinite(e.high);
  if (low && high) return fmt::format("{:.4g} to {:.4g}", e.low, e.high);
  return high ? fmt::format("up to {:.4g}", e.high) : low ? fmt::format("{:.4g} or more", e.low) : "anywhere";
}

std::string PercentOf(double share) {
  return fmt::format("{:.0f} %", 100.0 * share);
}

Table MarginTable(const std::vector<Margin>& margins) {
  Table table({{"key", "key"},
               {"range", "range"},
               {">crossed at"},
               {"95 %"},
               {">of the range"},
               {">rank", "rank"},
               {">runs", "runs"},
               {">without result", "without_result"}});
  for (const Margin& one : margins) {
    const Side side = SideOf(one);
    std::string at = "-";
    std::string part = "-";
    if (one.estimate && std::isfinite(one.estimate->estimate)) {
      at = fmt::format("{:.4g}", one.estimate->estimate);
      part = PercentOf(WithstoodBy(one).estimate);
    }
    if (side == Side::kAlwaysAbove) at = "above everywhere";
    if (side == Side::kAlwaysBelow) at = "below everywhere";
    const bool told = side == Side::kAlwaysAbove || side == Side::kAlwaysBelow;
    const VariedKey& key = one.plan.key;
    table.AddRow({key.key.path, fmt::format("{}..{}{}", key.low, key.high, key.log ? ":log" : ""), at,
                  told || !one.estimate ? "-" : IntervalText(*one.estimate), told ? "-" : part, one.rank,
                  CountCell(static_cast<std::uint64_t>(one.runs)),
                  CountCell(static_cast<std::uint64_t>(one.without_result))});
  }
  return table;
}

std::string RankText(const std::vector<Margin>& margins) {
  std::vector<std::string> least;
  bool crossed = false;
  for (const Margin& one : margins) {
    crossed = crossed || SideOf(one) != Side::kAlwaysBelow;
    if (one.rank == 1) least.push_back(one.plan.key.key.path);
  }
  if (!crossed) return "It withstands all of these ranges.";
  return fmt::format("Of these ranges it withstands least: {}{}.", fmt::join(least, ", "),
                     least.size() > 1 ? " (their intervals overlap)" : "");
}

Result<Margin> ReadMargin(const SearchPlan& plan, ResultStore& store,
                          const std::vector<StoredSearch>& stored) {
  TRY(const auto search, MakeStoredSearch(plan, store));
  TRY(RestoreSearch(plan.id, store, *search));
  const MarginStages* stages = search->Margin();
  if (stages == nullptr) return InvalidInput("it holds no margin: gauntlet margin makes one");
  const bool finished = std::ranges::any_of(stored, [&](const StoredSearch& one) {
    return one.id == plan.id && HasFinished(one, plan.experiment, *search);
  });
  return Margin{.experiment = plan.experiment,
                .plan = stages->plan(),
                .runs = stages->asked(),
                .without_result = stages->without_result(),
                .finished = finished,
                .estimate = stages->Estimate()};
}

}  // namespace

Result<std::vector<Margin>> ReadMargins(const std::string& dir) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
  ResultStore& store = *campaign.view.store;
  TRY(const std::vector<StoredSearch> stored, store.LoadSearches());
  std::vector<Margin> margins;
  for (const SearchPlan& plan : campaign.plans) {
    Result<Margin> margin = ReadMargin(plan, store, stored);
    if (!margin) return Error{margin.error().kind, fmt::format("{}: {}", dir, margin.error().message)};
    margins.push_back(std::move(*margin));
  }
  RankMargins(margins);
  return margins;
}

void RankMargins(std::vector<Margin>& margins) {
  std::vector<std::pair<Withstood, Margin*>> order;
  for (Margin& one : margins) {
    if (one.estimate) order.emplace_back(WithstoodBy(one), &one);
  }
  std::ranges::stable_sort(order, {}, [](const auto& one) { return one.first.estimate; });
  int rank = 0;
  double reaches = 0.0;  // the upper end of the first that has the rank
  for (auto& [withstood, margin] : order) {
    if (rank == 0 || withstood.low > reaches) {
      ++rank;
      reaches = withstood.high;
    }
    margin->rank = rank;
  }
}

std::string CrossesOf(const Margin& margin) {
  constexpr const char* kSides[] = {"within", "below_everywhere", "above_everywhere", "undecided"};
  return kSides[static_cast<int>(SideOf(margin))];
}

std::string OutcomeOf(const Margin& margin) {
  const std::string& path = margin.plan.key.key.path;
  const std::string share = PercentOf(margin.plan.share);
  if (!margin.estimate) return fmt::format("{}: no run has a result.", path);
  const MarginEstimate& e = *margin.estimate;
  const std::string range = fmt::format("{} from {} to {}", path, margin.plan.key.low, margin.plan.key.high);
  const std::string ends =
      fmt::format("they go from {} to {}", PercentOf(e.levels.front().fit), PercentOf(e.levels.back().fit));
  switch (SideOf(margin)) {
    case Side::kAlwaysAbove:
      return fmt::format("More than {} of the runs fail all along {} ({}).", share, range, ends);
    case Side::kAlwaysBelow:
      return fmt::format("Fewer than {} of the runs fail all along {} ({}).", share, range, ends);
    case Side::kCrosses:
      return fmt::format("Failures cross {} where {} is about {:.4g} ({}, 95 %).", share, path, e.estimate,
                         IntervalText(e));
    case Side::kUnknown:
      break;
  }
  return fmt::format("Whether failures cross {} within {} is not decided: the crossing may be at {} ({}).",
                     share, range, IntervalText(e), ends);
}

Table LevelTable(const Margin& margin) {
  Table table({{">" + margin.plan.key.key.path, "value"},
               {">failed", "failures"},
               {">runs", "runs"},
               {">share", "share"},
               {">monotone fit", "fit"}});
  if (!margin.estimate) return table;
  for (const MarginLevel& level : margin.estimate->levels) {
    const double share = static_cast<double>(level.failures) / level.runs;
    table.AddRow(
        {level.value, level.failures, level.runs, Cell(PercentOf(share), share), DecimalCell(level.fit, 3)});
  }
  return table;
}

std::vector<Section> TellMargins(const std::vector<Margin>& margins, const std::string& dir,
                                 const std::string& program) {
  const Margin& first = margins.front();
  Section all{.title = "Where failures begin"};
  all.lead = {
      fmt::format("{} in {}, {} of them at each value of a stage; everything else is as in the "
                  "experiment.",
                  first.experiment.name, Counted(first.plan.cases, "case"), MarginPlan::kCasesEach)};
  all.table = MarginTable(margins);
  for (const Margin& one : margins) all.sentences.push_back(OutcomeOf(one));
  if (margins.size() > 1) all.sentences.push_back(RankText(margins));
  const std::string place = PastedPath(dir);
  const bool finished = std::ranges::all_of(margins, &Margin::finished);
  if (!finished) {
    all.commands = {{fmt::format("{} resume {}", program, place), "go on"}};
  } else {
    all.commands = {{fmt::format("{} figure {} margin-1 -o margin.svg --csv margin.csv", program, place),
                     "the curve as a picture, and its data"},
                    {fmt::format("{} report {} -o margin.html", program, place), "the same as a page"}};
  }
  std::vector<Section> sections = {std::move(all)};
  for (const Margin& one : margins)
    sections.push_back(
        {.title = "Failures along " + one.plan.key.key.path, .table = LevelTable(one).Thinned(kMostLevels)});
  return sections;
}

nlohmann::ordered_json MarginValues(const std::vector<Margin>& margins) {
  using Json = nlohmann::ordered_json;
  Json keys = Json::array();
  for (const Margin& one : margins) {
    const MarginEstimate e = one.estimate.value_or(MarginEstimate{});
    const auto number = [](double value) { return JsonValue(NumberValue(value)); };
    Json points = Json::array();
    for (const MarginLevel& level : e.levels) {
      const auto interval =
          analysis::WilsonInterval(static_cast<std::uint32_t>(level.failures),
                                   static_cast<std::uint32_t>(level.runs), analysis::kConfidence);
      points.push_back({{"value", level.value},
                        {"k", level.failures},
                        {"n", level.runs},
                        {"interval", {interval.low, interval.high}},
                        {"fit", level.fit}});
    }
    keys.push_back({{"key", one.plan.key.key.path},
                    {"share", one.plan.share},
                    {"threshold", one.estimate ? Json{{"value", number(e.estimate)},
                                                      {"interval", {number(e.low), number(e.high)}}}
                                               : Json()},
                    {"low", one.plan.key.low},
                    {"high", one.plan.key.high},
                    {"logarithmic", one.plan.key.log},
                    {"crosses", CrossesOf(one)},
                    {"falls", e.falls},
                    {"design_effect", e.design_effect},
                    {"rank", one.rank},
                    {"runs", one.runs},
                    {"without_result", one.without_result},
                    {"points", std::move(points)},
                    {"outcome", OutcomeOf(one)}});
  }
  return keys;
}

std::string MarginJson(const std::vector<Margin>& margins, const std::string& dir) {
  nlohmann::ordered_json keys = MarginValues(margins);
  nlohmann::ordered_json json({{"directory", dir},
                               {"finished", std::ranges::all_of(margins, &Margin::finished)},
                               {"cases", margins.front().plan.cases}});
  if (keys.size() == 1) json.update(keys.front());
  json["keys"] = std::move(keys);
  return JsonText(json);
}

}  // namespace gauntlet
