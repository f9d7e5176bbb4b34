#include "tests/sim/physics/argos_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/geometry/trigonometry.h"
#include "tests/sim/argos_csv.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

OrientedBox Box(double x, double y, double length, double width, double orientation_deg = 0.0) {
  return MakeBox({x, y}, length, width, orientation_deg * kDegree);
}

constexpr WheelSpeeds kAhead = {0.10, 0.10};
constexpr WheelSpeeds kSlow = {0.05, 0.05};
constexpr WheelSpeeds kBrake = {0.0, 0.0};

}  // namespace

const std::vector<ArgosScene>& ArgosScenes() {
  static const std::vector<ArgosScene> scenes = {
      {"straight5", {kSlow}, {}, true},
      {"straight10", {kAhead}, {}, true},
      {"straight30", {{0.30, 0.30}}, {}, true},
      {"turn5", {{-0.05, 0.05}}, {}, true},
      {"turn10", {{-0.10, 0.10}}, {}, true},
      {"arc5_10", {{0.05, 0.10}}, {}, true},
      {"pivot0_10", {{0.0, 0.10}}, {}, true},
      {"wall_headon", {kAhead}, {Box(0.5, 0, 0.2, 2)}},
      {"wall_headon5", {kSlow}, {Box(0.5, 0, 0.2, 2)}},
      {"wall_20", {kAhead}, {Box(2, 0.3, 6, 0.1)}},
      {"wall_45", {kAhead}, {Box(2, 0.5, 6, 0.1)}},
      {"wall_70", {kAhead}, {Box(2, 0.5, 6, 0.1)}},
      {"arc_into_wall", {{0.08, 0.10}}, {Box(0, 0.5, 6, 0.1)}},
      {"turn_at_wall", {{-0.05, 0.05}}, {Box(0.5, 0, 0.2, 2)}},
      {"wall_corner", {kAhead}, {Box(0.6, 0, 0.4, 0.4)}},
      {"wall_corner_glance", {kAhead}, {Box(0.6, 0, 0.4, 0.4)}},
      {"vnotch", {kAhead}, {Box(0.4, 0.35, 1, 0.1, -30), Box(0.4, -0.35, 1, 0.1, 30)}},
      {"gap_17cm", {kAhead}, {Box(0.6, 0.585, 0.4, 1), Box(0.6, -0.585, 0.4, 1)}},
      {"gap_20cm", {kAhead}, {Box(0.6, 0.6, 0.4, 1), Box(0.6, -0.6, 0.4, 1)}},
      {"headon_0", {kAhead, kAhead}, {}},
      {"headon_2cm", {kAhead, kAhead}, {}},
      // Sliding around each other multiplies small differences of the first contact.
      {"headon_8cm", {kAhead, kAhead}, {}, false, 0.025},
      {"headon_5v10", {kAhead, kSlow}, {}},
      {"push_robot_0", {kAhead, kBrake}, {}},
      {"push_robot_2cm", {kAhead, kBrake}, {}},
      {"push_robot_8cm", {kAhead, kBrake}, {}, false, 0.025},
      {"push_two_robots", {kAhead, kBrake, kBrake}, {}},
      {"rear_end", {kAhead, kSlow}, {}},
  };
  return scenes;
}

const ArgosScene& FindArgosScene(const std::string& name) {
  const auto found = std::ranges::find(ArgosScenes(), name, &ArgosScene::name);
  EXPECT_NE(found, ArgosScenes().end()) << name;
  return *found;
}

Trajectory ArgosTrajectory(const ArgosScene& scene) {
  const CsvTable table = ReadArgosCsv("motion/" + scene.name + ".csv");
  Trajectory trajectory;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::size_t tick = static_cast<std::size_t>(table.At(row, "tick"));
    if (tick == trajectory.size()) trajectory.emplace_back();
    trajectory[tick].push_back({{table.At(row, "x"), table.At(row, "y")}, table.At(row, "heading")});
  }
  return trajectory;
}

Trajectory SimulateScene(const ArgosScene& scene, PhysicsEngine& engine) {
  const Trajectory argos = ArgosTrajectory(scene);
  const std::size_t robots = scene.commands.size();
  EXPECT_EQ(argos[0].size(), robots) << scene.name;
  for (const OrientedBox& box : scene.boxes) engine.AddBox(box);
  for (std::size_t i = 0; i < robots; ++i) engine.AddRobot(argos[0][i]);
  Trajectory trajectory = {argos[0]};
  const std::vector<WheelSpeeds> rest(robots);
  for (std::size_t tick = 1; tick < argos.size(); ++tick) {
    engine.Step(tick == 1 ? rest : scene.commands);
    trajectory.emplace_back();
    for (std::size_t i = 0; i < robots; ++i)
      trajectory[tick].push_back(engine.PoseOf(static_cast<RobotIndex>(i)));
  }
  return trajectory;
}

Deviation Compare(const Trajectory& a, const Trajectory& b, std::size_t end) {
  Deviation deviation;
  for (std::size_t tick = 0; tick < end; ++tick) {
    for (std::size_t i = 0; i < a[tick].size(); ++i) {
      deviation.position = std::max(deviation.position, (a[tick][i].position - b[tick][i].position).norm());
      deviation.heading =
          std::max(deviation.heading, std::abs(WrapAngle(a[tick][i].heading - b[tick][i].heading)));
    }
  }
  return deviation;
}

std::size_t TicksBeforeContact(const ArgosScene& scene, const Trajectory& trajectory, double gap) {
  const auto contact = [&](const std::vector<Pose>& poses) {
    for (std::size_t i = 0; i < scene.commands.size(); ++i) {
      for (const OrientedBox& box : scene.boxes) {
        if (Distance(box, poses[i].position) < foot_bot::kRadius + gap) return true;
      }
      for (std::size_t j = 0; j < i; ++j) {
        if ((poses[i].position - poses[j].position).norm() < 2 * foot_bot::kRadius + gap) return true;
      }
    }
    return false;
  };
  return static_cast<std::size_t>(std::ranges::find_if(trajectory, contact) - trajectory.begin());
}

Vec2 FinalVelocity(const Trajectory& trajectory, std::size_t robot, std::size_t ticks) {
  const std::size_t last = trajectory.size() - 1;
  return (trajectory[last][robot].position - trajectory[last - ticks][robot].position) /
         (static_cast<double>(ticks) * kTickSeconds);
}

}  // namespace gauntlet::sim
