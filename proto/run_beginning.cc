#include "proto/run_beginning.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "proto/json_text.h"

namespace gauntlet::proto {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kBeginningFormat = 1;
// m, around start and goal and around bodies: beyond the largest arena.
constexpr double kMaxDistance = sim::kMaxArenaSide;

Status CheckPlace(std::string_view what, const sim::Vec2& place) {
  const bool right = std::abs(place.x()) <= sim::kMaxCoordinate && std::abs(place.y()) <= sim::kMaxCoordinate;
  if (right) return Ok{};  // what is not a number is not right
  return InvalidInput(fmt::format("its {} is at {}; up to {} m from the middle is possible", what,
                                  PointText(place.x(), place.y()), NumberText(sim::kMaxCoordinate)));
}

Status CheckDistance(std::string_view what, double distance) {
  if (distance >= 0.0 && distance <= kMaxDistance) return Ok{};
  return InvalidInput(fmt::format("its {} is {} m; 0 to {} m is possible", what, NumberText(distance),
                                  NumberText(kMaxDistance)));
}

Status CheckBoxes(std::string_view what, const std::vector<sim::RoundedBox>& boxes) {
  for (const auto& [box, radius] : boxes) {
    TRY(CheckPlace(what, box.center));
    TRY(CheckDistance(what, radius));
  }
  return Ok{};
}

OrderedJson PointJson(const sim::Vec2& point) {
  return OrderedJson::array({point.x(), point.y()});
}

sim::Vec2 PointOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

OrderedJson BoxesJson(const std::vector<sim::RoundedBox>& boxes) {
  OrderedJson json = OrderedJson::array();
  for (const auto& [box, radius] : boxes) {
    json.push_back({{"at", PointJson(box.center)},
                    {"half_extents", PointJson(box.half_extents)},
                    {"axis", PointJson(box.axis)},
                    {"radius", radius}});
  }
  return json;
}

std::vector<sim::RoundedBox> BoxesOf(const Json& json) {
  std::vector<sim::RoundedBox> boxes;
  for (const Json& box : json) {
    boxes.push_back({{PointOf(box.at("at")), PointOf(box.at("half_extents")), PointOf(box.at("axis"))},
                     box.at("radius").get<double>()});
  }
  return boxes;
}

// What few scenarios ask for is written only where it is asked for: other answers keep their bytes.
OrderedJson RequirementsJson(const sim::ArenaRequirements& asked) {
  const sim::ArenaRequirements usual;
  OrderedJson json = {{"start", PointJson(asked.start)},
                      {"goal", PointJson(asked.goal)},
                      {"clearance", asked.clearance},
                      {"inflation", asked.inflation}};
  if (asked.cell_size != usual.cell_size) json["cell_size"] = asked.cell_size;
  if (!asked.asks_for_path) json["asks_for_path"] = false;
  for (const sim::Vec2& goal : asked.further_goals) json["further_goals"].push_back(PointJson(goal));
  if (!asked.keep_outs.empty()) json["keep_outs"] = BoxesJson(asked.keep_outs);
  if (!asked.standing.empty()) json["standing"] = BoxesJson(asked.standing);
  if (asked.least_side != usual.least_side) json["least_side"] = asked.least_side;
  if (asked.anywhere) json["anywhere"] = true;
  if (asked.open_share != usual.open_share) json["open_share"] = asked.open_share;
  return json;
}

sim::ArenaRequirements AskedIn(const Json& json) {
  sim::ArenaRequirements asked{.start = PointOf(json.at("start")),
                               .goal = PointOf(json.at("goal")),
                               .clearance = json.at("clearance"),
                               .inflation = json.at("inflation")};
  asked.cell_size = json.value("cell_size", asked.cell_size);
  asked.asks_for_path = json.value("asks_for_path", asked.asks_for_path);
  for (const Json& goal : json.value("further_goals", Json::array()))
    asked.further_goals.push_back(PointOf(goal));
  asked.keep_outs = BoxesOf(json.value("keep_outs", Json::array()));
  asked.standing = BoxesOf(json.value("standing", Json::array()));
  asked.least_side = json.value("least_side", asked.least_side);
  asked.anywhere = json.value("anywhere", asked.anywhere);
  asked.open_share = json.value("open_share", asked.open_share);
  return asked;
}

OrderedJson RobotJson(const sim::StartingRobot& robot) {
  OrderedJson devices = OrderedJson::array();
  for (const sim::DeviceInfo& info : sim::kDevices) {
    if (robot.devices.Has(info.device)) devices.push_back(info.key);
  }
  return {{"at", PointJson(robot.pose.position)},
          {"heading", robot.pose.heading},
          {"camera_range", robot.camera_range},
          {"radio_range", robot.radio_range},
          {"bodies_block_radio", robot.bodies_block_radio},
          {"devices", std::move(devices)},
          {"under_test", robot.under_test}};
}

sim::StartingRobot RobotOf(const Json& json) {
  sim::StartingRobot robot{.pose = {PointOf(json.at("at")), json.at("heading")},
                           .camera_range = json.at("camera_range"),
                           .radio_range = json.at("radio_range"),
                           .bodies_block_radio = json.at("bodies_block_radio"),
                           .devices = {},
                           .under_test = json.at("under_test")};
  for (const Json& key : json.at("devices")) {
    if (const auto device = sim::DeviceOfKey(key.get<std::string>())) robot.devices = robot.devices | *device;
  }
  return robot;
}

OrderedJson StartJson(const sim::RunStart& start) {
  OrderedJson robots = OrderedJson::array();
  for (const sim::StartingRobot& robot : start.robots) robots.push_back(RobotJson(robot));
  OrderedJson lights = OrderedJson::array();
  for (const sim::Light& light : start.lights) {
    lights.push_back({{"at", PointJson(light.position)},
                      {"height", light.height},
                      {"intensity", light.intensity},
                      {"color", sim::NameOf(light.color)},
                      {"occludable", light.occludable}});
  }
  OrderedJson areas = OrderedJson::array();
  for (const sim::GroundArea& area : start.ground_areas) {
    areas.push_back({{"name", area.name},
                     {"at", PointJson(area.center)},
                     {"radius", area.radius},
                     {"half_extents", PointJson(area.half_extents)},
                     {"grey", area.grey}});
  }
  return {{"robots", std::move(robots)},
          {"lights", std::move(lights)},
          {"radio_beacons", start.radio_beacons},
          {"ground_areas", std::move(areas)},
          {"tick_limit", start.tick_limit}};
}

sim::RunStart StartOf(const Json& json) {
  sim::RunStart start;
  for (const Json& robot : json.at("robots")) start.robots.push_back(RobotOf(robot));
  for (const Json& light : json.at("lights")) {
    const auto color = sim::ColorNamed(light.at("color").get<std::string>());
    start.lights.push_back({.position = PointOf(light.at("at")),
                            .height = light.at("height"),
                            .intensity = light.at("intensity"),
                            .color = color.value_or(sim::Color::kBlack),
                            .occludable = light.at("occludable")});
  }
  start.radio_beacons = json.at("radio_beacons");
  for (const Json& area : json.at("ground_areas")) {
    start.ground_areas.push_back({.name = area.at("name"),
                                  .center = PointOf(area.at("at")),
                                  .radius = area.at("radius"),
                                  .half_extents = PointOf(area.at("half_extents")),
                                  .grey = area.at("grey")});
  }
  start.tick_limit = json.at("tick_limit");
  return start;
}

}  // namespace

Status CheckBeginning(const sim::RunBeginning& beginning) {
  const sim::ArenaRequirements& asked = beginning.requirements;
  for (const Status& right :
       {CheckPlace("start", asked.start), CheckPlace("goal", asked.goal),
        CheckDistance("clearance", asked.clearance), CheckDistance("inflation", asked.inflation),
        CheckDistance("cell", asked.cell_size), CheckBoxes("keep-out", asked.keep_outs),
        CheckBoxes("standing box", asked.standing)}) {
    if (!right) return InvalidInput("what it asks of an arena is wrong: " + right.error().message);
  }
  if (!beginning.start) return Ok{};
  if (beginning.start->robots.empty()) return InvalidInput("its swarm has no robots");
  for (const sim::StartingRobot& robot : beginning.start->robots) {
    if (const Status right = CheckPlace("robot", robot.pose.position); !right)
      return InvalidInput("its swarm is wrong: " + right.error().message);
  }
  return Ok{};
}

std::string WriteBeginning(const sim::RunBeginning& beginning) {
  OrderedJson json = {{"format", kBeginningFormat},
                      {"requirements", RequirementsJson(beginning.requirements)}};
  if (beginning.start) {
    json["start"] = StartJson(*beginning.start);
  } else {
    json["refused"] = beginning.start.error().message;
  }
  return JsonText(json);
}

Result<sim::RunBeginning> ReadBeginning(std::string_view text, const std::string& place) {
  TRY(const auto json, ParseJson(text, place));
  sim::RunBeginning beginning{{}, InvalidInput("")};
  try {
    if (json.at("format") != kBeginningFormat)
      return InvalidInput(fmt::format("{}: no beginning of a run in format {}", place, kBeginningFormat));
    beginning.requirements = AskedIn(json.at("requirements"));
    if (const auto refused = json.find("refused"); refused != json.end()) {
      beginning.start = InvalidInput(refused->get<std::string>());
    } else {
      beginning.start = StartOf(json.at("start"));
    }
  } catch (const Json::exception&) {
    return InvalidInput(fmt::format("{}: no beginning of a run", place));
  }
  if (const Status right = CheckBeginning(beginning); !right)
    return InvalidInput(fmt::format("{}: {}", place, right.error().message));
  return beginning;
}

}  // namespace gauntlet::proto
