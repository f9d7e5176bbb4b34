#include "report/pages/report_document.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "analysis/figures/run/run_panel.h"
#include "report/pages/base64.h"
#include "sim/arena/arena.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoses = 10'000;  // of a run, so that a report of forty stays below 5 MB
constexpr std::size_t kLeastMoments = 100;

// Rounded to a tenth of a millimetre: half the bytes.
double Short(double metres) {
  return std::round(metres * 1e4) / 1e4;
}

Json PointJson(const sim::Vec2& point) {
  return Json::array({Short(point.x()), Short(point.y())});
}

// `share` 0 to 1 as a whole number from 0 to `most`.
unsigned Quantised(double share, double most) {
  return static_cast<unsigned>(std::lround(std::clamp(share, 0.0, 1.0) * most));
}

void AppendPose(const sim::RobotState& state, const sim::TestCase& arena, std::vector<unsigned char>& bytes) {
  constexpr unsigned kTurn = 256;
  const unsigned x = Quantised((state.x - arena.center.x()) / arena.side_x + 0.5, 4095.0);
  const unsigned y = Quantised((state.y - arena.center.y()) / arena.side_y + 0.5, 4095.0);
  const unsigned heading = Quantised(state.heading / (2 * std::numbers::pi) + 0.5, kTurn) % kTurn;
  for (const unsigned byte : {x & 255U, (x >> 8U) | ((y & 15U) << 4U), y >> 4U, heading})
    bytes.push_back(static_cast<unsigned char>(byte));
}

// Which ticks are shown: evenly spread ones and the last.
std::vector<std::size_t> MomentsOf(std::size_t ticks, std::size_t robots) {
  const std::size_t most = std::max(kLeastMoments, kMostPoses / std::max<std::size_t>(robots, 1));
  const std::size_t step = (ticks + most - 1) / most;
  std::vector<std::size_t> moments;
  for (std::size_t tick = 0; tick + 1 < ticks; tick += step) moments.push_back(tick);
  moments.push_back(ticks - 1);
  return moments;
}

void AddAnnotations(const analysis::RunFigure& figure, Json& json) {
  for (const char* list : {"places", "lines", "moments", "trapped"}) json[list] = Json::array();
  for (const sim::AnnotationStyle& style : figure.style.annotations) {
    for (const sim::Annotation& one : figure.result.annotations) {
      if (one.kind != style.kind || one.points.empty()) continue;
      if (!style.label.empty() && one.label != style.label) continue;
      const sim::Vec2& at = one.points.front();
      const Json place = {{"mark", analysis::ClassOf(style.mark)},
                          {"x", Short(at.x())},
                          {"y", Short(at.y())},
                          {"r", Short(one.radius)},
                          {"label", one.label}};
      switch (style.mark) {
        case sim::Mark::kGoal:
        case sim::Mark::kNest:
        case sim::Mark::kFood:
          json["places"].push_back(place);
          break;
        case sim::Mark::kPlan:
        case sim::Mark::kChain: {
          Json points = Json::array();
          for (const sim::Vec2& point : one.points) points.push_back(PointJson(point));
          json["lines"].push_back({{"mark", analysis::ClassOf(style.mark)}, {"points", std::move(points)}});
          break;
        }
        case sim::Mark::kSplit:
        case sim::Mark::kTransfer: {
          Json moment = place;
          moment["mark"] = style.mark == sim::Mark::kSplit ? "split" : "beacon";
          moment["time"] = one.tick * sim::kTickSeconds;
          json["moments"].push_back(std::move(moment));
          break;
        }
        default:
          break;
      }
    }
  }
  for (const sim::Annotation& one : figure.result.annotations) {
    if (one.kind != "trapped") continue;
    for (const sim::RobotIndex robot : one.robots)
      json["trapped"].push_back({{"robot", robot}, {"time", one.tick * sim::kTickSeconds}});
  }
}

// m: how far robots see or hear one another, as the scenario's parameters say; null where none does.
Json SightRangeOf(const sim::RunSpec& spec) {
  for (const char* name : {"link_range", "communication_range"}) {
    const auto found = spec.scenario_parameters.find(name);
    if (found != spec.scenario_parameters.end()) return found->second;
  }
  return nullptr;
}

Json CampaignJson(const CampaignPages& pages, bool served) {
  const Table table = CaseTable(pages.facts, served ? 0 : pages.facts.cases.size());
  Json columns = Json::array();
  for (const Column& column : table.columns())
    columns.push_back({{"key", column.key}, {"title", column.title}, {"number", column.at_right}});
  Json types = Json::array();
  if (const SearchSummary* only = pages.facts.summary.OnlySearch(); only != nullptr) {
    for (const auto& [type, runs] : only->runs_of_type) types.push_back(only->types.Find(type)->name);
  }
  return {{"directory", pages.facts.directory},
          {"runs_done", pages.facts.summary.runs_done},
          {"failure_types", std::move(types)},
          {"case_columns", std::move(columns)},
          {"cases", served ? Json() : table.ToJsonRows()}};
}

}  // namespace

Json ReplayDocument(const analysis::RunFigure& figure) {
  const sim::TestCase& test_case = figure.spec.test_case;
  const auto& ticks = figure.result.trajectory;
  const std::size_t robots = ticks.front().size();
  Json json = {{"side_x", test_case.side_x},         {"side_y", test_case.side_y},
               {"wall", test_case.wall_thickness},   {"robots", robots},
               {"guide", analysis::GuideOf(figure)}, {"guide_name", figure.style.guide},
               {"member", figure.style.member},      {"sight_range", SightRangeOf(figure.spec)}};
  if (test_case.center != sim::Vec2::Zero()) json["center"] = PointJson(test_case.center);
  Json lost = Json::array();
  for (const sim::RobotSummary& robot : figure.result.robots) lost.push_back(robot.lost);
  json["lost"] = std::move(lost);
  Json obstacles = Json::array();
  const sim::Arena arena(test_case);
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    Json corners = Json::array();
    for (const sim::Vec2& corner : arena.VisiblePart(i)) corners.push_back(PointJson(corner));
    obstacles.push_back(std::move(corners));
  }
  json["obstacles"] = std::move(obstacles);
  AddAnnotations(figure, json);
  std::vector<unsigned char> poses;
  Json times = Json::array();
  for (const std::size_t tick : MomentsOf(ticks.size(), robots)) {
    times.push_back(static_cast<double>(tick) / sim::kTicksPerSecond);
    for (const sim::RobotState& state : ticks[tick]) AppendPose(state, test_case, poses);
  }
  json["times"] = std::move(times);
  Json last = Json::array();
  for (const sim::RobotState& state : ticks.back()) last.push_back({state.x, state.y, state.heading});
  json["last"] = std::move(last);
  json["poses"] = Base64(poses);
  return json;
}

Json ReportDocument(const Report& report) {
  const std::vector<CampaignPages>& campaigns = report.campaigns;
  Json json = {{"served", report.served}, {"campaigns", Json::array()}, {"replays", Json::object()}};
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    json["campaigns"].push_back(CampaignJson(campaigns[i], report.served));
    if (report.served) continue;
    for (const ShownRun& shown : campaigns[i].shown) {
      if (shown.figure.result.trajectory.empty()) continue;
      json["replays"][IdOfRun(i, shown.report.stored.id)] = ReplayDocument(shown.figure);
    }
  }
  return json;
}

}  // namespace gauntlet
