#include "cli/adopt/adopted_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/sample.h"
#include "base/key.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "base/shell_quoted.h"

namespace gauntlet {
namespace {

constexpr double kBeside = 1.0;         // m, that obstacles may lie beside where robots were seen
constexpr double kLargestSide = 100;    // m, of an arena
constexpr double kAroundRobot = 0.01;   // m
constexpr double kLeastRadius = 0.001;  // m

double Rounded(double value) {
  return std::round(value * 1e6) / 1e6;
}

std::string Numbers(double value) {
  return NumberText(Rounded(value));
}

sim::Vec2 SideOf(const sim::Rectangle& area) {
  return area.max - area.min;
}

std::string Rectangle(const char* table, const ArenaBody& body, double around) {
  return fmt::format("\n# {} {}\n[[command.{}]]\nx = {}\ny = {}\nlength = {}\nwidth = {}\n",
                     Printable(body.kind), Printable(body.id), table,
                     Numbers((body.x_min + body.x_max) / 2.0), Numbers((body.y_min + body.y_max) / 2.0),
                     Numbers(body.x_max - body.x_min + 2.0 * around),
                     Numbers(body.y_max - body.y_min + 2.0 * around));
}

std::string Standing(const AdoptedProject& project, const ArenaBody& body) {
  const auto box = project.form.boxes.find(body.id);
  if (body.kind == "box" && box != project.form.boxes.end()) {
    const sim::ObstacleGene& gene = box->second;
    return fmt::format(
        "\n# box {}\n[[command.standing]]\nx = {}\ny = {}\nlength = {}\nwidth = {}\ndegrees = {}\n",
        Printable(body.id), Numbers(gene.x), Numbers(gene.y), Numbers(gene.length), Numbers(gene.width),
        Numbers(gene.orientation_deg));
  }
  if (body.kind == "cylinder") {
    return fmt::format("\n# cylinder {}\n[[command.standing]]\nx = {}\ny = {}\nradius = {}\n",
                       Printable(body.id), Numbers(body.x), Numbers(body.y),
                       Numbers((body.x_max - body.x_min) / 2.0));
  }
  return Rectangle("standing", body, 0.0);
}

bool HasArea(const ArenaBody& body) {
  return body.x_max > body.x_min && body.y_max > body.y_min;
}

std::string ParameterText(const ArgosParameter& parameter) {
  const double value = parameter.value;
  const double far = value == 0.0 ? 1.0 : 10.0 * value;
  return fmt::format("\n[[command.parameter]]\nname = {}\ndefault = {}\nlow = {}\nhigh = {}\n",
                     QuoteToml(parameter.name), NumberText(value), NumberText(std::min(0.0, far)),
                     NumberText(std::max(0.0, far)));
}

std::string SetupOf(const AdoptedProject& project) {
  std::string setup;
  for (const std::string& variable : project.environment) {
    const std::size_t equals = variable.find('=');
    setup += fmt::format("{}export {}={}", setup.empty() ? "" : "; ", variable.substr(0, equals),
                         ShellQuoted(variable.substr(equals + 1)));
  }
  return setup;
}

// Each kilobot has a process of its own that ARGoS stops and continues each tick. Where a filter is asked for
// every signal, some of these come too late, and the run waits for ever.
std::string ConfineOf(const AdoptedProject& project) {
  const bool kilobots = std::ranges::count(project.robots, "kilobot", &ArenaBody::kind) > 0;
  return kilobots ? "# Kilobots are processes that are stopped and continued: no filter comes "
                    "between.\nconfine = false\n"
                  : "";
}

// What chance does not bring about without obstacles: worse than ever, by a quarter than usual, and than one
// run in a hundred would be (Student's prediction interval of a further run).
double FailureBelow(const std::vector<double>& scores) {
  constexpr double kWorse = 0.25;
  constexpr double kByChance = 0.01;
  const analysis::Description usual = analysis::Describe(scores);
  const double worse = std::min(usual.minimum, usual.mean - kWorse * std::abs(usual.mean));
  if (!usual.sd) return worse;
  const auto runs = static_cast<double>(usual.n);
  const double further = *usual.sd * std::sqrt(1.0 + 1.0 / runs);
  return std::min(worse, usual.mean - analysis::StudentUpperQuantile(kByChance, runs - 1.0) * further);
}

std::string AxisText(const std::string& metric, double low, double high) {
  return fmt::format("\n[[command.axis]]\nmetric = \"{}\"\nmin = {}\nmax = {}\nparts = 5\n", metric,
                     Numbers(low), Numbers(high));
}

std::string AxesText(const AdoptedProject& project) {
  const auto [least, most] = std::ranges::minmax(project.scores);
  const double low = std::min(0.0, 1.5 * least);
  const double high = most > 0.0 ? 1.5 * most : 0.0;
  const sim::Vec2 side = SideOf(ObstacleArea(project));
  return AxisText("score", low, high > low ? high : low + 1.0) +
         AxisText("displacement", 0.0, side.norm() / 2.0);
}

std::string SearchText(const AdoptedProject& project) {
  const sim::Rectangle area = ObstacleArea(project);
  const double step = ObstacleStep(area);
  return fmt::format(
      R"(
# Where obstacles are laid: what of the arena the robots went to, and a metre around it.
[arena]
x_min = {}
x_max = {}
y_min = {}
y_max = {}
wall_thickness = {}

[genome]
genes = 3
length_min = {}
length_max = {}
width_min = {}
width_max = {}
step = {}

[search]
algorithm = "archive"
runs = 300
)",
      Numbers(area.min.x()), Numbers(area.max.x()), Numbers(area.min.y()), Numbers(area.max.y()),
      Numbers(std::min(0.02, step / 5.0)), Numbers(2.0 * step), Numbers(10.0 * step), Numbers(step),
      Numbers(step), Numbers(step));
}

}  // namespace

double RobotRadius(const AdoptedProject& project) {
  double radius = kLeastRadius;
  for (const ArenaBody& robot : project.robots)
    radius = std::max({radius, (robot.x_max - robot.x_min) / 2.0, (robot.y_max - robot.y_min) / 2.0});
  return radius;
}

sim::Rectangle ObstacleArea(const AdoptedProject& project) {
  sim::Rectangle area = project.form.arena;
  if (project.poses.empty()) return area;
  sim::Vec2 least(project.poses.front().x, project.poses.front().y);
  sim::Vec2 most = least;
  for (const Pose& pose : project.poses) {
    least = least.cwiseMin(sim::Vec2(pose.x, pose.y));
    most = most.cwiseMax(sim::Vec2(pose.x, pose.y));
  }
  const sim::Vec2 beside(kBeside, kBeside);
  area.min = area.min.cwiseMax(least - beside);
  area.max = area.max.cwiseMin(most + beside);
  const sim::Vec2 middle = (area.min + area.max) / 2.0;
  const sim::Vec2 half = (SideOf(area) / 2.0).cwiseMin(sim::Vec2(kLargestSide / 2.0, kLargestSide / 2.0));
  return {middle - half, middle + half};
}

double ObstacleStep(const sim::Rectangle& area) {
  const double rough = SideOf(area).minCoeff() / 20.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double digit : {5.0, 2.0})
    if (rough >= digit * power) return std::max(0.005, digit * power);
  return std::max(0.005, power);
}

std::optional<sim::ObstacleGene> ObstacleInTheWay(const AdoptedProject& project, const TrialRun& run) {
  const double step = ObstacleStep(ObstacleArea(project));
  // Squares by how often they were visited.
  std::map<std::pair<int, int>, int> visits;
  for (const Pose& pose : run.poses)
    ++visits[{static_cast<int>(std::floor(pose.x / step)), static_cast<int>(std::floor(pose.y / step))}];
  std::vector<std::pair<int, std::pair<int, int>>> most;
  for (const auto& [square, count] : visits) most.emplace_back(-count, square);
  std::ranges::sort(most);
  for (const double length : {6.0 * step, 3.0 * step, step}) {
    for (const auto& [count, square] : most) {
      const sim::Vec2 place((square.first + 0.5) * step, (square.second + 0.5) * step);
      const sim::Vec2 half(length / 2.0 + kAroundRobot, step / 2.0 + kAroundRobot);
      const auto touches = [&](const ArenaBody& body) {
        return place.x() + half.x() > body.x_min && place.x() - half.x() < body.x_max &&
               place.y() + half.y() > body.y_min && place.y() - half.y() < body.y_max;
      };
      if (std::ranges::any_of(run.bodies, touches)) continue;
      return sim::ObstacleGene{Rounded(place.x()), Rounded(place.y()), Rounded(length), Rounded(step), 0.0};
    }
  }
  return std::nullopt;
}

std::string AdoptedExperimentText(const AdoptedProject& project) {
  std::string text = fmt::format(
      R"(# Made by gauntlet adopt of {}: every line may be changed.
name = {}
description = {}
scenario = "command"

[command]
run = ["sh", {}, "{{case}}"]
files = [{}]
template = {}
trajectory = "gauntlet-trajectory.csv"
# Lower is tougher: of a score of which less is better, write "-score", and "score > ..." in `failure`.
fitness = "score"
# Less than in any of {} runs without obstacles, by a quarter than their mean, and than one such run in a hundred would
# have by chance. They had
# {}.
failure = "score < {}"
wall_limit = {}
robot_radius = {}
place = {{ x = "center_x", y = "center_y", same_within = {} }}
{}setup = {}

[[command.refused]]
pattern = "gauntlet: the robots find no room"

[[command.metric]]
name = "score"
from = {}
)",
      Printable(project.argos_file), QuoteToml(project.name),
      QuoteToml("the ARGoS project of " + project.argos_file), QuoteToml(project.own + "/run.sh"),
      QuoteToml(project.own), QuoteToml(project.own + "/case.argos"), project.scores.size(),
      fmt::join(project.scores, ", "), fmt::format("{:.4g}", FailureBelow(project.scores)),
      NumberText(std::ceil(10.0 + 20.0 * project.seconds)), Numbers(RobotRadius(project)),
      Numbers(SideOf(ObstacleArea(project)).minCoeff() / 10.0), ConfineOf(project),
      QuoteToml(SetupOf(project)), QuoteToml(project.score));
  for (const char* name : {"displacement", "center_x", "center_y", "covered_area"})
    text += fmt::format("\n[[command.metric]]\nname = \"{0}\"\nfrom = \"trajectory:{0}\"\n", name);
  text += AxesText(project);
  for (const ArenaBody& body : project.fixed)
    if (HasArea(body)) text += Rectangle("keep_out", body, kAroundRobot);
  for (const ArenaBody& body : project.standing)
    if (HasArea(body)) text += Standing(project, body);
  for (const ArgosParameter& parameter : project.form.parameters) text += ParameterText(parameter);
  return text + SearchText(project);
}

}  // namespace gauntlet
