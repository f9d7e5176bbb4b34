#include "proto/run_beginning.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

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

OrderedJson PointJson(const sim::Vec2& point) {
  return OrderedJson::array({point.x(), point.y()});
}

sim::Vec2 PointOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
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
        CheckDistance("clearance", asked.clearance), CheckDistance("inflation", asked.inflation)}) {
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
  const sim::ArenaRequirements& asked = beginning.requirements;
  OrderedJson json = {{"format", kBeginningFormat},
                      {"requirements",
                       {{"start", PointJson(asked.start)},
                        {"goal", PointJson(asked.goal)},
                        {"clearance", asked.clearance},
                        {"inflation", asked.inflation}}}};
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
    const Json& asked = json.at("requirements");
    beginning.requirements = {.start = PointOf(asked.at("start")),
                              .goal = PointOf(asked.at("goal")),
                              .clearance = asked.at("clearance"),
                              .inflation = asked.at("inflation")};
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
