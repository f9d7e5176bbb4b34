#include "controllers/command/outcome.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "controllers/command/command_rows.h"
#include "controllers/command/left_file.h"
#include "controllers/command/metric_source.h"
#include "controllers/command/placeholders.h"
#include "controllers/command/requirements.h"
#include "controllers/command/trajectory_file.h"
#include "controllers/command/trajectory_measures.h"
#include "controllers/generic/formula.h"
#include "controllers/requirements/run_judge.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;

constexpr std::size_t kMostOutBytes = std::size_t{64} << 20;

// The whole file, or its end; nothing when there is none.
std::optional<std::string> EndOfFile(const std::string& path) {
  std::ifstream file = OpenLeftFile(path, /*at_end=*/true);
  if (!file) return std::nullopt;
  const auto size = static_cast<std::size_t>(file.tellg());
  std::string bytes(std::min(size, kMostOutBytes), '\0');
  file.seekg(static_cast<std::streamoff>(size - bytes.size()));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

struct Printed {
  std::string out;
  std::string err;
};
Printed PrintedIn(const std::string& folder) {
  return {EndOfFile(folder + "/" + kStdoutFile).value_or(""),
          EndOfFile(folder + "/" + kStderrFile).value_or("")};
}

std::optional<json> ObjectIn(std::string_view text) {
  json object = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return std::nullopt;
  return object;
}

std::optional<json> LastObject(std::string_view text) {
  while (!text.empty()) {
    const std::size_t begin = text.rfind('\n', text.size() - 1) + 1;  // npos + 1 = 0
    const std::string_view line = text.substr(begin);
    if (line.find('{') < line.size() && line.size() <= kMostLineBytes) {
      if (auto object = ObjectIn(line)) return object;
    }
    text = text.substr(0, begin == 0 ? 0 : begin - 1);
  }
  return std::nullopt;
}

Result<json> ReportOf(const std::string& folder, std::string_view out) {
  if (const std::optional<std::string> file = EndOfFile(folder + "/" + kOutFile)) {
    if (auto object = ObjectIn(*file)) return std::move(*object);
    return InvalidInput(std::string(kOutFile) +
                        " holds no JSON object (NaN and Infinity, which some programs write, are no JSON)");
  }
  if (auto object = LastObject(out)) return std::move(*object);
  return InvalidInput(std::string("it has neither written ") + kOutFile +
                      " ({out}) nor printed a line that is a JSON object");
}

Result<double> ReportedNumber(const json& report, const std::string& name) {
  const auto found = report.find(name);
  if (found == report.end()) {
    std::vector<std::string> names;
    for (const auto& [key, value] : report.items()) names.push_back(key);
    return InvalidInput(
        "it reports no '" + name + "'; " +
        (names.empty() ? "its JSON object is empty" : "it reports " + Printable(NamesOf(names))));
  }
  if (found->is_boolean()) return found->get<bool>() ? 1.0 : 0.0;
  if (found->is_number() && std::isfinite(found->get<double>())) return found->get<double>();
  return InvalidInput("'" + name +
                      "' = " + Printable(found->dump(-1, ' ', false, json::error_handler_t::replace)) +
                      " is no finite number");
}

// Formulas see the values of the metrics that stand before them.
Result<double> Computed(const std::string& formula, const sim::RunResult& result) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, value] : result.metrics) {
    names.push_back(name);
    values.push_back(value);
  }
  TRY(generic::Formula compiled, generic::Formula::Compile(formula, names));
  return compiled.Evaluate(values);
}

// What a picture shows besides robots and obstacles.
std::vector<sim::Annotation> PlacesOf(const Definition& definition) {
  std::vector<sim::Annotation> places;
  for (const Shape& shape : definition.standing) {
    const sim::Vec2 center(shape.x, shape.y);
    if (shape.radius > 0.0) {
      places.push_back(
          {.kind = "disc", .label = kStanding, .points = {center}, .radius = shape.radius, .robots = {}});
      continue;
    }
    const auto box = BoxOf(sim::ObstacleGene{shape.x, shape.y, shape.length, shape.width, shape.degrees});
    const auto corners = Corners(box);
    places.push_back(
        {.kind = "area", .label = kStanding, .points = {corners.begin(), corners.end()}, .robots = {}});
  }
  for (const Point& point : definition.points)
    places.push_back({.kind = "disc",
                      .label = point.name,
                      .points = {sim::Vec2(point.x, point.y)},
                      .radius = definition.robot_radius,
                      .robots = {}});
  return places;
}

// What a replay is drawn by, with more rows than what counts.
Status ReadReplay(const Definition& definition, const std::string& folder, sim::RunResult& result) {
  const std::string name = definition.trajectory + kReplayEnding;
  sim::RunResult finer;
  if (!OpenLeftFile(folder + "/" + name)) return Ok{};
  TRY(ReadTrajectory(folder + "/" + name, name, /*record=*/true, finer));
  if (finer.robots.size() != result.robots.size())
    return InvalidInput("its file " + name + " has " + std::to_string(finer.robots.size()) + " robots, " +
                        definition.trajectory + " has " + std::to_string(result.robots.size()));
  result.trajectory = std::move(finer.trajectory);
  return Ok{};
}

Result<std::optional<requirements::RunJudge>> JudgeFor(const Definition& definition,
                                                       const sim::RunSpec& spec) {
  if (spec.requirements.empty()) return std::optional<requirements::RunJudge>();
  TRY(requirements::RunJudge judge,
      requirements::RunJudge::Make(spec, RowsOf(definition).scenarios.front(), RequirementsOf(definition)));
  if (judge.Measures() && definition.trajectory.empty())
    return InvalidInput("requirements: a program without a trajectory is judged by its metrics alone");
  return std::optional(std::move(judge));
}

// Without a trajectory nothing of the robots counts.
void JudgeTrajectory(const requirements::RunJudge& judge, const sim::RunSpec& spec, sim::RunResult& result) {
  const std::vector<std::vector<sim::RobotState>> nobody = {{sim::RobotState{}}};
  const sim::Observer observer = ObserverOf(result.trajectory.empty() ? nobody : result.trajectory);
  std::vector<sim::RobotIndex> robots(static_cast<std::size_t>(observer.robots()));
  std::iota(robots.begin(), robots.end(), 0);
  judge.Judge(observer, sim::Arena(spec.test_case), std::move(robots), result);
}

}  // namespace

std::optional<std::string> RefusedBy(const Definition& definition, const std::string& folder) {
  if (definition.refused.empty()) return std::nullopt;
  const Printed printed = PrintedIn(folder);
  for (const std::string& pattern : definition.refused) {
    for (const std::string* text : {&printed.out, &printed.err}) {
      if (auto line = FirstLineWith(pattern, *text)) return line;
    }
  }
  return std::nullopt;
}

Result<sim::RunResult> OutcomeOf(const Definition& definition, const sim::RunSpec& spec,
                                 const std::string& folder) {
  sim::RunResult result;
  const Printed printed = PrintedIn(folder);
  std::map<std::string, double> measured;
  const auto of_trajectory = [](const Metric& metric) { return metric.from.starts_with(kTrajectorySource); };
  TRY(const std::optional<requirements::RunJudge> judge, JudgeFor(definition, spec));
  const bool measures =
      std::ranges::any_of(definition.metrics, of_trajectory) || (judge && judge->Measures());
  if (!definition.trajectory.empty()) {
    TRY(ReadTrajectory(folder + "/" + definition.trajectory, definition.trajectory,
                       spec.record_trajectory || measures, result));
  }
  if (measures) measured = TrajectoryMeasures(definition, spec, result.trajectory);
  std::optional<json> report;
  for (const Metric& metric : definition.metrics) {
    double value = 0.0;
    if (of_trajectory(metric)) {
      value = measured.at(metric.from.substr(kTrajectorySource.size()));
    } else if (!metric.from.empty()) {
      TRY(value, ReadSource(metric.from, printed.out, printed.err, folder));
    } else if (!metric.formula.empty()) {
      TRY(value, Computed(metric.formula, result));
    } else {
      if (!report) {
        TRY(report, ReportOf(folder, printed.out));
      }
      TRY(value, ReportedNumber(*report, metric.name));
    }
    result.metrics.emplace_back(metric.name, value);
  }
  TRY(result.fitness, Computed(definition.fitness, result));
  TRY(const double failed, Computed(definition.failure, result));
  result.failure.total = failed != 0.0;
  result.annotations = PlacesOf(definition);
  if (judge) JudgeTrajectory(*judge, spec, result);
  if (!spec.record_trajectory) result.trajectory.clear();
  sim::SetHashes(result);
  if (spec.record_trajectory && !definition.trajectory.empty()) {
    TRY(ReadReplay(definition, folder, result));
  }
  return result;
}

}  // namespace gauntlet::controllers::command
