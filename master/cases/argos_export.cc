#include "master/cases/argos_export.h"

#include <cstddef>
#include <iterator>

#include <fmt/format.h>

namespace gauntlet::master {
namespace {

constexpr double kHeight = 1.0;  // m, of walls and obstacles, as in the files of the thesis' author

void AppendBox(const std::string& id, const sim::ObstacleGene& box, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "    <box id=\"{}\" movable=\"false\" size=\"{},{},{}\">\n"
                 "      <body position=\"{},{},0\" orientation=\"{},0,0\"/>\n"
                 "    </box>\n",
                 id, box.length, box.width, kHeight, box.x, box.y, box.orientation_deg);
}

void AppendWalls(const sim::TestCase& test_case, std::string& out) {
  const double x = test_case.side_x;
  const double y = test_case.side_y;
  const double thickness = test_case.wall_thickness;
  AppendBox("wall_north", {0.0, y / 2, x, thickness, 0.0}, out);
  AppendBox("wall_south", {0.0, -y / 2, x, thickness, 0.0}, out);
  AppendBox("wall_east", {x / 2, 0.0, y, thickness, 90.0}, out);
  AppendBox("wall_west", {-x / 2, 0.0, y, thickness, 90.0}, out);
}

void AppendRobots(int robots, const sim::Rectangle& area, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "    <distribute>\n"
                 "      <position method=\"uniform\" min=\"{},{},0\" max=\"{},{},0\"/>\n"
                 "      <orientation method=\"uniform\" min=\"0,0,0\" max=\"360,0,0\"/>\n"
                 "      <entity quantity=\"{}\" max_trials=\"100\">\n"
                 "        <foot-bot id=\"fb\"><controller config=\"controller\"/></foot-bot>\n"
                 "      </entity>\n"
                 "    </distribute>\n",
                 area.min.x(), area.min.y(), area.max.x(), area.max.y(), robots);
}

}  // namespace

Result<std::string> WriteArgos(const sim::TestCase& test_case) {
  if (test_case.robots.has_value() != test_case.spawn_area.has_value())
    return InvalidInput(
        "an .argos file cannot say how many robots start without saying where, or where without "
        "how many");
  std::string out = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!-- The environment of a test case: the controllers are for you to add. -->\n"
      "<argos-configuration>\n"
      "  <framework>\n"
      "    <experiment length=\"0\" ticks_per_second=\"10\" random_seed=\"1\"/>\n"
      "  </framework>\n"
      "  <controllers/>\n"
      "  <arena size=\"{},{},{}\" center=\"0,0,{}\">\n",
      test_case.side_x, test_case.side_y, kHeight, kHeight / 2);
  AppendWalls(test_case, out);
  for (std::size_t i = 0; i < test_case.obstacles.size(); ++i) {
    const sim::ObstacleGene& obstacle = test_case.obstacles[i];
    if (!obstacle.Plain())
      return InvalidInput(
          fmt::format("obstacle {} moves or carries lights, which an .argos file cannot say", i + 1));
    AppendBox(fmt::format("obstacle_{}", i + 1), obstacle, out);
  }
  if (test_case.robots) AppendRobots(*test_case.robots, *test_case.spawn_area, out);
  out +=
      "  </arena>\n"
      "  <physics_engines><dynamics2d id=\"dyn2d\"/></physics_engines>\n"
      "  <media/>\n"
      "</argos-configuration>\n";
  return out;
}

}  // namespace gauntlet::master
