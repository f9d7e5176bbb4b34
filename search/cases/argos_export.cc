#include "search/cases/argos_export.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/printable.h"
#include "base/utf8.h"
#include "search/cases/argos_form.h"

namespace gauntlet {
namespace {

using pugi::xml_node;
using sim::Device;

constexpr double kHeight = 1.0;  // m, of walls and obstacles, as in the files of the thesis' author
constexpr const char* kPlaceholder = "controller";

// A device as ARGoS calls it: one element, or one each for reading and acting.
struct DeviceElement {
  Device device;
  const char* group;  // "actuators" or "sensors"
  const char* tag;
  const char* implementation;
  const char* medium = nullptr;
};
constexpr DeviceElement kDeviceElements[] = {
    {Device::kWheels, "actuators", "differential_steering", "default"},
    {Device::kLeds, "actuators", "leds", "default", "leds"},
    {Device::kRangeAndBearing, "actuators", "range_and_bearing", "default"},
    {Device::kGripper, "actuators", "footbot_gripper", "default"},
    {Device::kDistanceScanner, "actuators", "footbot_distance_scanner", "default"},
    {Device::kProximity, "sensors", "footbot_proximity", "default"},
    {Device::kOmnidirectionalCamera, "sensors", "colored_blob_omnidirectional_camera", "rot_z_only", "leds"},
    {Device::kRangeAndBearing, "sensors", "range_and_bearing", "medium", "rab"},
    {Device::kLight, "sensors", "footbot_light", "rot_z_only"},
    {Device::kMotorGround, "sensors", "footbot_motor_ground", "rot_z_only"},
    {Device::kBaseGround, "sensors", "footbot_base_ground", "rot_z_only"},
    {Device::kDistanceScanner, "sensors", "footbot_distance_scanner", "rot_z_only"},
    {Device::kPositioning, "sensors", "positioning", "default"},
    {Device::kWheelEncoders, "sensors", "differential_steering", "default"},
};

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

xml_node Append(xml_node parent, const char* name, Attributes attributes = {}) {
  xml_node node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

void AppendBox(xml_node arena, std::string_view id, const sim::ObstacleGene& box) {
  const xml_node element = Append(arena, "box",
                                  {{"id", std::string(id)},
                                   {"size", fmt::format("{},{},{}", box.length, box.width, kHeight)},
                                   {"movable", "false"}});
  Append(element, "body",
         {{"position", fmt::format("{},{},0", box.x, box.y)},
          {"orientation", fmt::format("{},0,0", box.orientation_deg)}});
}

void AppendBoxes(xml_node arena, const sim::TestCase& test_case) {
  const double x = test_case.center.x();
  const double y = test_case.center.y();
  const double along_x = test_case.side_x;
  const double along_y = test_case.side_y;
  const double thickness = test_case.wall_thickness;
  AppendBox(arena, kWallIds[0], {x, y + along_y / 2, along_x, thickness, 0.0});
  AppendBox(arena, kWallIds[1], {x, y - along_y / 2, along_x, thickness, 0.0});
  AppendBox(arena, kWallIds[2], {x + along_x / 2, y, along_y, thickness, 90.0});
  AppendBox(arena, kWallIds[3], {x - along_x / 2, y, along_y, thickness, 90.0});
  for (std::size_t i = 0; i < test_case.obstacles.size(); ++i)
    AppendBox(arena, ObstacleId(i + 1), test_case.obstacles[i]);
}

void AppendLights(xml_node arena, const std::vector<sim::Light>& lights) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const sim::Light& light = lights[i];
    Append(arena, "light",
           {{"id", fmt::format("light_{}", i + 1)},
            {"position", fmt::format("{},{},{}", light.position.x(), light.position.y(), light.height)},
            {"orientation", "0,0,0"},
            {"color", std::string(NameOf(light.color))},
            {"intensity", fmt::format("{}", light.intensity)},
            {"medium", "leds"}});
  }
}

void AppendRobots(xml_node arena, const std::vector<sim::StartingRobot>& robots,
                  const ArgosControllers* given) {
  // Of the robots under test; the scenario's own have the others.
  constexpr const char* kIds = "fb";
  const std::string ids = given == nullptr ? kIds : given->robots.value_or(kIds);
  const std::string controller = given == nullptr ? kPlaceholder : given->id;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const sim::StartingRobot& robot = robots[i];
    xml_node element = Append(arena, "foot-bot",
                              {{"id", fmt::format("{}{}", robot.under_test ? ids : kIds, i)},
                               {"rab_range", fmt::format("{}", robot.radio_range)}});
    if (given != nullptr && given->message_bytes)
      element.append_attribute("rab_data_size") = *given->message_bytes;
    if (robot.camera_range > 0.0) {
      const double aperture = std::atan(robot.camera_range / sim::foot_bot::kCameraHeight);
      element.append_attribute("omnidirectional_camera_aperture") = DegreesText(aperture).c_str();
    }
    Append(element, "body",
           {{"position", fmt::format("{},{},0", robot.pose.position.x(), robot.pose.position.y())},
            {"orientation", fmt::format("{},0,0", DegreesText(robot.pose.heading))}});
    Append(element, "controller", {{"config", robot.under_test ? controller : kScenarioController}});
  }
}

// A controller that does nothing and has these devices.
void AppendPlaceholder(xml_node parent, const char* id, sim::DeviceSet devices) {
  const xml_node controller = Append(parent, "lua_controller", {{"id", id}});
  for (const char* group : {"actuators", "sensors"}) {
    const xml_node list = Append(controller, group);
    for (const DeviceElement& device : kDeviceElements) {
      if (!devices.Has(device.device) || std::string_view(device.group) != group) continue;
      xml_node element = Append(list, device.tag, {{"implementation", device.implementation}});
      if (device.medium != nullptr) element.append_attribute("medium") = device.medium;
    }
  }
  Append(controller, "params");
}

void AppendControllers(xml_node root, const sim::RunStart& start, const ArgosControllers* given) {
  xml_node parent = Append(root, "controllers");
  if (given != nullptr) {
    parent.append_buffer(given->sections.data(), given->sections.size());
  } else {
    sim::DeviceSet devices;
    for (const auto& robot : start.robots)
      if (robot.under_test) devices = devices | robot.devices;
    AppendPlaceholder(parent, kPlaceholder, devices);
  }
  const bool own = std::ranges::any_of(start.robots, [](const auto& robot) { return !robot.under_test; });
  if (own && !parent.find_child_by_attribute("id", kScenarioController))
    AppendPlaceholder(parent, kScenarioController, {});
}

bool IsControlCharacter(char c) {
  return (c >= 0 && c < ' ') || c == 0x7f;
}

// What ARGoS has no words for, so that reading the file gives the very same case.
void AppendOwn(xml_node root, const sim::RunSpec& spec) {
  const sim::TestCase& test_case = spec.test_case;
  xml_node own = Append(root, kOwnElement, {{"seed", fmt::format("{}", spec.seed)}});
  // XML has no words for some bytes; a case with such a name gets that of the file.
  if (IsUtf8(test_case.name) && std::ranges::none_of(test_case.name, IsControlCharacter))
    own.append_attribute("name") = test_case.name.c_str();
  if (const auto& area = test_case.spawn_area) {
    own.append_attribute("spawn_area") =
        fmt::format("{},{},{},{}", area->min.x(), area->min.y(), area->max.x(), area->max.y()).c_str();
  }
  for (std::size_t i = 0; i < test_case.obstacles.size(); ++i) {
    const sim::ObstacleGene& gene = test_case.obstacles[i];
    if (gene.Plain()) continue;
    std::string path;
    for (const sim::Vec2& point : gene.path)
      path += fmt::format("{}{},{}", path.empty() ? "" : " ", point.x(), point.y());
    Append(own, "obstacle",
           {{"id", ObstacleId(i + 1)},
            {"path", path},
            {"speed", fmt::format("{}", gene.speed)},
            {"light", std::string(NameOf(gene.light))}});
  }
}

std::string AreaText(const sim::GroundArea& area) {
  const std::string shape =
      area.radius > 0.0
          ? fmt::format("disc of radius {} m", area.radius)
          : fmt::format("rectangle of {} x {} m", 2.0 * area.half_extents.x(), 2.0 * area.half_extents.y());
  const std::string grey = area.grey < 1.0 ? fmt::format(", of grey {} (0 is black)", area.grey) : "";
  return fmt::format("The {} is a {} at ({}, {}){}.", area.name, shape, area.center.x(), area.center.y(),
                     grey);
}

std::vector<std::string> NoticesOf(const sim::RunSpec& spec, const sim::RunStart& start) {
  std::vector<std::string> notices;
  const auto any = [](const auto& all, auto&& has) { return std::ranges::any_of(all, has); };
  const sim::Genome& obstacles = spec.test_case.obstacles;
  if (any(obstacles, &sim::ObstacleGene::Moves))
    notices.emplace_back("Obstacles that move stand in ARGoS, each where it begins.");
  if (any(obstacles, &sim::ObstacleGene::Lit)) notices.emplace_back("Obstacles have no lamps in ARGoS.");
  if (any(start.robots, [](const auto& robot) { return !robot.under_test; }))
    notices.push_back(fmt::format(
        "The robot with the controller '{}' belongs to the scenario and stands still: give it a controller.",
        kScenarioController));
  for (const sim::GroundArea& area : start.ground_areas) notices.push_back(AreaText(area));
  if (!start.ground_areas.empty()) {
    notices.emplace_back(
        "Items and colours of the floor are for loop functions in ARGoS; without them the floor is white.");
  }
  if (any(start.lights, [](const sim::Light& light) { return !light.occludable; }))
    notices.emplace_back("Lamps are hidden by what stands before them in ARGoS, which one here is not.");
  if (start.radio_beacons > 0)
    notices.emplace_back(
        "Messages that come from no robot, such as those of the nest, are not sent in ARGoS.");
  if (any(start.robots, [](const auto& robot) { return !robot.bodies_block_radio; }))
    notices.emplace_back("Robots hide messages from one another in ARGoS, which they do not here.");
  if (!spec.disturbances.None()) notices.emplace_back("Noise and faults of the run are not in the file.");
  return notices;
}

// XML wants no two hyphens in a comment, and none at its end.
std::string CommentText(const std::vector<std::string>& lines) {
  std::string text = "\n";
  for (const std::string& line : lines) text += "  " + Printable(line) + "\n";
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--"))
    text.insert(at + 1, " ");
  return text;
}

// As controllers that were written for ARGoS are seeded here (argos/controller_adapter.cc), so that they draw
// the same numbers there. ARGoS takes 32 bits, and 0 for the time of day.
std::uint32_t ArgosSeed(std::uint64_t seed) {
  const auto folded = static_cast<std::uint32_t>(seed ^ seed >> 32);
  return folded == 0 ? 1 : folded;
}

// m: ARGoS indexes lamps and LEDs by cells of whole metres and ends a run with one outside of them.
double ArenaHeight(const std::vector<sim::Light>& lights) {
  double height = kHeight;
  for (const sim::Light& light : lights) height = std::max(height, std::floor(light.height) + 1.0);
  return height;
}

}  // namespace

ArgosFile WriteArgos(const sim::RunSpec& spec, const sim::RunStart& start,
                     const ArgosControllers* controllers, const std::string& title) {
  ArgosFile file{"", NoticesOf(spec, start)};
  if (controllers == nullptr) {
    file.notices.insert(
        file.notices.begin(),
        "The robots' controller is a placeholder that does nothing (it needs ARGoS with Lua): "
        "replace it by yours (--controller-file).");
  }
  pugi::xml_document document;
  const xml_node root = Append(document, "argos-configuration");
  std::vector<std::string> lines = {title, "argos3 -n -z -c FILE runs it."};
  lines.insert(lines.end(), file.notices.begin(), file.notices.end());
  document.prepend_child(pugi::node_comment).set_value(CommentText(lines).c_str());

  const xml_node framework = Append(root, "framework");
  Append(framework, "system", {{"threads", "0"}});
  Append(framework, "experiment",
         {{"length", fmt::format("{}", start.tick_limit / static_cast<double>(sim::kTicksPerSecond))},
          {"ticks_per_second", fmt::format("{}", sim::kTicksPerSecond)},
          {"random_seed", fmt::format("{}", ArgosSeed(spec.seed))}});
  AppendControllers(root, start, controllers);

  const sim::TestCase& test_case = spec.test_case;
  const double height = ArenaHeight(start.lights);
  const xml_node arena =
      Append(root, "arena",
             {{"size", fmt::format("{},{},{}", test_case.side_x, test_case.side_y, height)},
              {"center", fmt::format("{},{},{}", test_case.center.x(), test_case.center.y(), height / 2.0)}});
  Append(arena, "floor", {{"id", "floor"}, {"source", "loop_functions"}, {"pixels_per_meter", "50"}});
  AppendBoxes(arena, test_case);
  AppendLights(arena, start.lights);
  AppendRobots(arena, start.robots, controllers);

  Append(Append(root, "physics_engines"), "dynamics2d", {{"id", "dyn2d"}});
  const xml_node media = Append(root, "media");
  Append(media, "led", {{"id", "leds"}});
  Append(media, "range_and_bearing", {{"id", "rab"}});
  AppendOwn(root, spec);

  std::ostringstream text;
  document.save(text, "  ");
  file.text = text.str();
  return file;
}

}  // namespace gauntlet
