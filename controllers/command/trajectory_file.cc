#include "controllers/command/trajectory_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "controllers/command/left_file.h"
#include "controllers/parameters.h"
#include "sim/arena/validity.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::command {
namespace {

constexpr std::array<std::string_view, 6> kColumns = {"time", "robot", "kind", "x", "y", "heading"};
enum Column : std::size_t { kTime, kRobot, kKind, kX, kY, kHeading };
constexpr std::size_t kMostStates = 20'000'000;  // rows, and places of a recorded trajectory
constexpr sim::Tick kMostTicks = 10'000'000;

std::vector<std::string_view> Split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(',');
    std::string_view field = line.substr(0, end);
    while (!field.empty() && (field.front() == ' ' || field.front() == '"')) field.remove_prefix(1);
    while (!field.empty() && std::string_view(" \"\r").find(field.back()) != std::string_view::npos)
      field.remove_suffix(1);
    fields.push_back(field);
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

struct Sighting {
  sim::Tick tick = 0;
  sim::RobotState state;
};

double Wrapped(double heading) {
  const double turns = heading / (2.0 * sim::kPi);
  return (turns - std::ceil(turns - 0.5)) * 2.0 * sim::kPi;
}

class Reader {
 public:
  Status Add(std::string_view line) {
    const std::vector<std::string_view> fields = Split(line);
    if (!columns_) {
      columns_.emplace();
      const bool named = !ParseNumber<double>(fields[0]);
      for (std::size_t i = 0; i < kColumns.size(); ++i) {
        const auto found = std::ranges::find(fields, kColumns[i]);
        (*columns_)[i] = named ? static_cast<std::size_t>(found - fields.begin()) : i;
      }
      for (const Column needed : {kTime, kRobot, kX, kY}) {
        if (named && (*columns_)[needed] == fields.size())
          return InvalidInput(" has no column " + std::string(kColumns[needed]));
      }
      if (named) return Ok{};
    }
    TRY(const double time, Number(fields, kTime));
    Sighting sighting{.tick = 0, .state = {}};
    if (!(time >= 0.0 && time * sim::kTicksPerSecond <= kMostTicks))
      return InvalidInput(": time " + NumberText(time) + "; s from the beginning are expected");
    sighting.tick = ToTicks(time);
    if (sighting.tick < last_tick_)
      return InvalidInput(": time " + NumberText(time) + " lies before the last");
    last_tick_ = sighting.tick;
    TRY(sighting.state.x, Number(fields, kX));
    TRY(sighting.state.y, Number(fields, kY));
    if (Has(fields, kHeading)) {
      TRY(const double heading, Number(fields, kHeading));
      sighting.state.heading = Wrapped(heading);
    }
    if (++rows_ > kMostStates) return InvalidInput(" has more than " + FormatCount(kMostStates) + " rows");
    for (const double value : {time, sighting.state.x, sighting.state.y, sighting.state.heading})
      hash_.AddDouble(value);
    const std::string robot(Field(fields, kRobot));
    hash_.AddBytes(robot);
    const auto [found, added] = numbers_.try_emplace(robot, seen_.size());
    if (added) seen_.emplace_back();
    if (seen_.size() > sim::kMaxRobots)
      return InvalidInput(" has more than " + std::to_string(sim::kMaxRobots) + " robots");
    seen_[found->second].push_back(sighting);
    return Ok{};
  }

  Status Finish(bool record, sim::RunResult& result) const {
    if (seen_.empty()) return InvalidInput(" has no rows");
    result.ticks = last_tick_;
    result.trajectory_hash = hash_.value();
    const std::size_t states = seen_.size() * (static_cast<std::size_t>(last_tick_) + 1);
    if (record && states > kMostStates)
      return InvalidInput(" is too long to be replayed: " + FormatCount(states) +
                          " places, one for each 0.1 s");
    if (record) result.trajectory.assign(static_cast<std::size_t>(last_tick_) + 1, {});
    for (const std::vector<Sighting>& robot : seen_) {
      sim::RobotSummary& summary = result.robots.emplace_back();
      const auto pose = [](const sim::RobotState& state) {
        return sim::Pose{state.position(), state.heading};
      };
      summary.start = pose(robot.front().state);
      summary.end = pose(robot.back().state);
      for (std::size_t i = 1; i < robot.size(); ++i) {
        const sim::Vec2 step = robot[i].state.position() - robot[i - 1].state.position();
        summary.path_length += std::sqrt(step.squaredNorm());
      }
      std::size_t at = 0;
      for (sim::Tick tick = 0; tick <= last_tick_; record ? ++tick : tick += sim::kSummaryTicks) {
        while (at + 1 < robot.size() && robot[at + 1].tick <= tick) ++at;
        if (tick % sim::kSummaryTicks == 0) summary.waypoints.push_back(robot[at].state.position());
        if (record) result.trajectory[static_cast<std::size_t>(tick)].push_back(robot[at].state);
      }
    }
    return Ok{};
  }

 private:
  bool Has(const std::vector<std::string_view>& fields, Column column) const {
    return (*columns_)[column] < fields.size();
  }
  std::string_view Field(const std::vector<std::string_view>& fields, Column column) const {
    return Has(fields, column) ? fields[(*columns_)[column]] : std::string_view();
  }
  Result<double> Number(const std::vector<std::string_view>& fields, Column column) const {
    const std::string_view field = Field(fields, column);
    const std::optional<double> number = ParseNumber<double>(field);
    if (number && std::isfinite(*number)) return *number;
    return InvalidInput(": " + std::string(kColumns[column]) + " = '" +
                        Printable(std::string(field.substr(0, 40))) + "' is no finite number");
  }

  std::optional<std::array<std::size_t, kColumns.size()>> columns_;  // where each stands; beyond: nowhere
  std::map<std::string, std::size_t> numbers_;                       // of robots, in the order of coming
  std::vector<std::vector<Sighting>> seen_;
  sim::Tick last_tick_ = 0;
  std::size_t rows_ = 0;
  Fnv1a64 hash_;
};

}  // namespace

Status ReadTrajectory(const std::string& path, const std::string& name, bool record, sim::RunResult& result) {
  std::ifstream file = OpenLeftFile(path);
  if (!file) return InvalidInput("it has left no file " + name);
  Reader reader;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line == "\r") continue;
    if (const Status added = reader.Add(line); !added)
      return InvalidInput("its file " + name + ", line " + std::to_string(number) + added.error().message);
  }
  if (const Status finished = reader.Finish(record, result); !finished)
    return InvalidInput("its file " + name + finished.error().message);
  return Ok{};
}

}  // namespace gauntlet::controllers::command
