#include "search/cases/case_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/split.h"
#include "base/utf8.h"
#include "search/cases/argos_controllers.h"
#include "search/cases/argos_form.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr double kWallTolerance = 0.01;  // m
constexpr int kMostRobots = 10000;       // more is a slip of the pen
// A foot-bot's camera looks from 0.289 m above the floor: ARGoS lets it see over lower boxes, we do not.
constexpr double kCameraHeight = 0.29;  // m

template <typename Number>
std::optional<Number> ReadNumber(std::string_view text) {
  text = Trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::optional<Number> value = ParseNumber<Number>(text);
  return value && std::isfinite(static_cast<double>(*value)) ? value : std::nullopt;
}

class Importer {
 public:
  Importer(const std::string& text, std::string file_name) : text_(text), file_name_(std::move(file_name)) {}

  Result<LoadedCase> Import() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text_.data(), text_.size());
    if (!parsed) return Fail(parsed.offset, fmt::format("malformed XML: {}", parsed.description()));
    const pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) != "argos-configuration") {
      return Fail(root, fmt::format("the root element is <{}>, expected <argos-configuration>", root.name()));
    }
    for (const pugi::xml_node more : document.children()) {
      if (more.type() == pugi::node_element && more != root) {
        return Fail(more, fmt::format("<{}> follows the end of <{}>: a file holds one document", more.name(),
                                      root.name()));
      }
    }
    const pugi::xml_node arena = root.child("arena");
    if (!arena) return Fail(root, "<argos-configuration> has no <arena>");
    const pugi::xml_node own = root.child(kOwnElement);
    if (own) known_ = {kOwnElement, "framework", "controllers", "physics_engines", "media", "floor", "light"};
    for (const pugi::xml_node child : root.children()) {
      if (child.type() == pugi::node_element && child != arena) Ignore(child.name());
    }
    TRY(ReadArena(arena));
    SeparateWalls();
    TRY(ReadOwn(own));
    return LoadedCase{test_case_, Notice()};
  }

 private:
  using Triple = std::array<double, 3>;

  Error Fail(std::ptrdiff_t offset, std::string_view message) const {
    const std::string place = PlaceIn(text_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return InvalidInput(Printable(fmt::format("{}:{}: {}", file_name_, place, message)));
  }
  Error Fail(const pugi::xml_node& node, std::string_view message) const {
    return Fail(node.offset_debug(), message);
  }

  // "<box id="Wall3">", or the element's name alone.
  static std::string Called(const pugi::xml_node& node) {
    const pugi::xml_attribute id = node.attribute("id");
    return id ? fmt::format("<{} id=\"{}\">", node.name(), id.value()) : fmt::format("<{}>", node.name());
  }

  // Numbers "a,b,c" of an attribute of `node`. `owner` is the element a person looks for.
  template <std::size_t kCount>
  Result<std::array<double, kCount>> ReadNumbers(const pugi::xml_node& node, const char* name,
                                                 std::string_view meaning,
                                                 const pugi::xml_node& owner) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute) return Fail(node, fmt::format("{} has no {}=\"{}\"", Called(owner), name, meaning));
    return NumbersIn<kCount>(attribute.value(), node, name, meaning, owner);
  }
  template <std::size_t kCount>
  Result<std::array<double, kCount>> NumbersIn(std::string_view text, const pugi::xml_node& node,
                                               const char* name, std::string_view meaning,
                                               const pugi::xml_node& owner) const {
    std::array<double, kCount> numbers{};
    std::size_t count = 0;
    for (std::size_t begin = 0; begin <= text.size(); ++count) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string_view part = text.substr(begin, end - begin);
      const std::optional<double> number = ReadNumber<double>(part);
      if (!number) {
        return Fail(node, fmt::format("{} has {}=\"{}\": '{}' is not a number, expected \"{}\"",
                                      Called(owner), name, text, Trimmed(part), meaning));
      }
      if (count < kCount) numbers[count] = *number;
      begin = end + 1;
    }
    if (count != kCount) {
      return Fail(node, fmt::format("{} has {}=\"{}\": {} numbers, expected \"{}\"", Called(owner), name,
                                    text, count, meaning));
    }
    return numbers;
  }
  Result<Triple> ReadTriple(const pugi::xml_node& node, const char* name, std::string_view meaning,
                            const pugi::xml_node& owner) const {
    return ReadNumbers<3>(node, name, meaning, owner);
  }
  Result<Triple> ReadTripleOrZero(const pugi::xml_node& node, const char* name, std::string_view meaning,
                                  const pugi::xml_node& owner) const {
    return node.attribute(name) ? ReadTriple(node, name, meaning, owner) : Result<Triple>(Triple{});
  }

  void Ignore(std::string_view what) {
    if (known_.contains(what) || std::ranges::count(ignored_, what) > 0) return;
    ignored_.emplace_back(what);
  }

  Status ReadArena(const pugi::xml_node& arena) {
    TRY(const auto size, ReadTriple(arena, "size", "x,y,z in m", arena));
    TRY(const auto center, ReadTripleOrZero(arena, "center", "x,y,z in m", arena));
    test_case_.name = file_name_;
    test_case_.side_x = size[0];
    test_case_.side_y = size[1];
    // Foreign files are moved to the origin: those of our own that lie elsewhere are meant to.
    sim::Vec2& middle = known_.empty() ? center_ : test_case_.center;
    middle = {center[0], center[1]};
    for (const pugi::xml_node child : arena.children()) {
      if (child.type() != pugi::node_element) continue;
      TRY(ReadEntity(child));
    }
    if (robots_ > kMostRobots) {
      return Fail(arena, fmt::format("{} foot-bots; at most {} can be meant", robots_, kMostRobots));
    }
    if (robots_ > 0) test_case_.robots = static_cast<int>(robots_);
    if (static_cast<std::int64_t>(poses_.size()) == robots_) {
      test_case_.start_poses = poses_;
    } else if (!poses_.empty()) {
      Ignore("poses of single foot-bots, as others are distributed");
    }
    return Ok{};
  }

  Status ReadEntity(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    if (name == "box") return ReadBox(node);
    if (name == "distribute") return ReadDistribute(node);
    if (name == "cylinder") {
      return Fail(node, fmt::format("{} is round: obstacles must be boxes", Called(node)));
    }
    if (name == "foot-bot") return ReadRobot(node);
    Ignore(name);
    return Ok{};
  }

  Status ReadRobot(const pugi::xml_node& node) {
    const bool of_scenario =
        std::string_view(node.child("controller").attribute("config").value()) == kScenarioController;
    if (of_scenario && !known_.empty()) return Ok{};  // the scenario brings it
    ++robots_;
    const pugi::xml_node body = node.child("body");
    if (!body) return Fail(node, fmt::format("{} has no <body>", Called(node)));
    TRY(const auto position, ReadTripleOrZero(body, "position", "x,y,z in m", node));
    TRY(const auto heading, ReadHeading(body, node));
    poses_.push_back({sim::Vec2{position[0], position[1]} - center_, heading});
    return Ok{};
  }

  // rad: the rotation about z, which `<body orientation>` names first, with more digits than a double has.
  Result<double> ReadHeading(const pugi::xml_node& body, const pugi::xml_node& owner) const {
    TRY(ReadTripleOrZero(body, "orientation", "z,y,x in degrees", owner));
    const std::string_view text = body.attribute("orientation").value();
    const auto degrees = ReadNumber<long double>(text.substr(0, text.find(',')));
    return sim::WrapAngle(HeadingOf(degrees.value_or(0.0L)));
  }

  Status ReadBox(const pugi::xml_node& node) {
    TRY(const auto size, ReadTriple(node, "size", "length,width,height in m", node));
    const pugi::xml_node body = node.child("body");
    if (!body) return Fail(node, fmt::format("{} has no <body>", Called(node)));
    TRY(const auto position, ReadTripleOrZero(body, "position", "x,y,z in m", node));
    TRY(const auto orientation, ReadTripleOrZero(body, "orientation", "z,y,x in degrees", node));
    if (std::fmod(orientation[1], 360.0) != 0.0 || std::fmod(orientation[2], 360.0) != 0.0) {
      return Fail(
          body, fmt::format("{} has orientation=\"{}\": boxes may be rotated about z only, the first number",
                            Called(node), body.attribute("orientation").value()));
    }
    double degrees = std::fmod(orientation[0], 360.0);
    if (degrees < 0.0) degrees += 360.0;
    if (degrees >= 360.0) degrees = 0.0;
    Box& box = boxes_.emplace_back();
    box.id = node.attribute("id").value();
    box.gene.x = position[0] - center_.x();
    box.gene.y = position[1] - center_.y();
    box.gene.length = size[0];
    box.gene.width = size[1];
    box.gene.orientation_deg = degrees;
    if (node.attribute("movable").as_bool()) ++movable_;
    if (position[2] + size[2] < kCameraHeight) ++low_;
    return Ok{};
  }

  Status ReadDistribute(const pugi::xml_node& node) {
    std::int64_t robots_here = 0;
    for (const pugi::xml_node entity : node.children("entity")) {
      const pugi::xml_node robot = entity.child("foot-bot");
      if (!robot) {
        Ignore(fmt::format("distributed {}", entity.first_child().name()));
        continue;
      }
      const pugi::xml_attribute quantity = entity.attribute("quantity");
      const std::optional<std::int32_t> count = ReadNumber<std::int32_t>(quantity.value());
      if (!count || *count < 1) {
        return Fail(entity,
                    fmt::format("<entity> of {} has quantity=\"{}\", expected a whole number from 1 on",
                                Called(robot), quantity.value()));
      }
      robots_here += *count;
    }
    robots_ += robots_here;
    if (robots_here == 0) return Ok{};
    if (node.child("orientation")) Ignore("start orientations");
    const pugi::xml_node position = node.child("position");
    const std::string_view method = position.attribute("method").value();
    if (method == "uniform") return AddSpawnArea(position);
    Ignore(fmt::format("start positions (method \"{}\")", method));
    return Ok{};
  }

  Status AddSpawnArea(const pugi::xml_node& position) {
    TRY(const auto min, ReadTriple(position, "min", "x,y,z in m", position));
    TRY(const auto max, ReadTriple(position, "max", "x,y,z in m", position));
    if (min[0] > max[0] || min[1] > max[1]) {
      return Fail(position,
                  fmt::format("<position> has min=\"{}\" beyond max=\"{}\"",
                              position.attribute("min").value(), position.attribute("max").value()));
    }
    sim::Rectangle area{sim::Vec2{min[0], min[1]} - center_, sim::Vec2{max[0], max[1]} - center_};
    if (test_case_.spawn_area) {
      area.min = area.min.cwiseMin(test_case_.spawn_area->min);
      area.max = area.max.cwiseMax(test_case_.spawn_area->max);
    }
    test_case_.spawn_area = area;
    return Ok{};
  }

  static bool Near(double a, double b) { return std::abs(a - b) <= kWallTolerance; }

  // The thickness of the wall that the box is, and its side (0: +y, 1: -y, 2: +x, 3: -x); nothing for an
  // obstacle.
  struct Wall {
    int side;
    double thickness;
  };
  std::optional<Wall> AsWall(const sim::ObstacleGene& box) const {
    // Length along x or y after a rotation by a multiple of 90 degrees.
    const double quarter = box.orientation_deg / 90.0;
    if (quarter != std::floor(quarter)) return std::nullopt;
    const bool turned = static_cast<int>(quarter) % 2 == 1;
    const double extent_x = turned ? box.width : box.length;
    const double extent_y = turned ? box.length : box.width;
    if (Near(box.x, 0.0) && Near(std::abs(box.y), test_case_.side_y / 2) && extent_x > extent_y) {
      const bool whole = Near(extent_x, test_case_.side_x) || Near(extent_x, test_case_.side_x + extent_y);
      if (whole) return Wall{box.y > 0 ? 0 : 1, extent_y};
    }
    if (Near(box.y, 0.0) && Near(std::abs(box.x), test_case_.side_x / 2) && extent_y > extent_x) {
      const bool whole = Near(extent_y, test_case_.side_y) || Near(extent_y, test_case_.side_y + extent_x);
      if (whole) return Wall{box.x > 0 ? 2 : 3, extent_x};
    }
    return std::nullopt;
  }

  // The same of a file that we wrote, where an obstacle may stand as a wall does.
  static std::optional<Wall> OwnWall(const sim::ObstacleGene& box, const std::string& id) {
    const auto side = std::ranges::find(kWallIds, id);
    if (side == std::end(kWallIds)) return std::nullopt;
    return Wall{static_cast<int>(side - std::begin(kWallIds)), box.width};
  }

  void SeparateWalls() {
    std::optional<double> thickness;
    for (const auto& [box, id] : boxes_) {
      const std::optional<Wall> wall = known_.empty() ? AsWall(box) : OwnWall(box, id);
      if (wall && wall->thickness > 0 && (!thickness || Near(wall->thickness, *thickness))) {
        if (!thickness) thickness = wall->thickness;
        walls_.insert(wall->side);
      } else {
        test_case_.obstacles.push_back(box);
        obstacle_ids_.push_back(id);
      }
    }
    if (thickness) test_case_.wall_thickness = *thickness;
  }

  // What ARGoS has no words for, of files that we wrote.
  Status ReadOwn(const pugi::xml_node& own) {
    if (const pugi::xml_attribute name = own.attribute("name")) test_case_.name = name.value();
    if (own.attribute("spawn_area")) {
      TRY(const auto area, ReadNumbers<4>(own, "spawn_area", "min x,min y,max x,max y in m", own));
      test_case_.spawn_area = sim::Rectangle{{area[0], area[1]}, {area[2], area[3]}};
    }
    for (const pugi::xml_node obstacle : own.children("obstacle")) {
      const auto found = std::ranges::find(obstacle_ids_, obstacle.attribute("id").value());
      if (found == obstacle_ids_.end())
        return Fail(obstacle,
                    fmt::format("{} of <{}> is no box of the arena", Called(obstacle), kOwnElement));
      TRY(ReadMotionAndLight(obstacle,
                             test_case_.obstacles[static_cast<std::size_t>(found - obstacle_ids_.begin())]));
    }
    return Ok{};
  }

  Status ReadMotionAndLight(const pugi::xml_node& node, sim::ObstacleGene& obstacle) const {
    TRY(const auto numbers, ReadNumbers<1>(node, "speed", "m/s", node));
    obstacle.speed = numbers[0];
    const std::optional<sim::Color> light = sim::ColorNamed(node.attribute("light").value());
    if (!light) {
      return Fail(node, fmt::format("{} has light=\"{}\", expected one of {}", Called(node),
                                    node.attribute("light").value(), fmt::join(sim::kColorNames, ", ")));
    }
    obstacle.light = *light;
    const std::string_view path = node.attribute("path").value();
    for (std::size_t begin = 0; begin < path.size();) {
      const std::size_t end = std::min(path.find(' ', begin), path.size());
      TRY(const auto point,
          NumbersIn<2>(path.substr(begin, end - begin), node, "path", "x,y x,y in m", node));
      obstacle.path.emplace_back(point[0], point[1]);
      begin = end + 1;
    }
    return Ok{};
  }

  std::string Notice() const {
    std::vector<std::string> parts;
    if (walls_.size() < 4) {
      parts.push_back(fmt::format("{} of 4 walls are in the file, the others were added", walls_.size()));
    }
    if (robots_ == 0) parts.emplace_back("no foot-bots, so the scenario's number is taken");
    if (movable_ > 0) parts.push_back(fmt::format("{} movable boxes were made fixed", movable_));
    if (low_ > 0) {
      parts.push_back(fmt::format("{} boxes lower than a robot's camera were made as high as a wall", low_));
    }
    if (!ignored_.empty()) parts.push_back(fmt::format("ignored: {}", fmt::join(ignored_, ", ")));
    return fmt::format("{}", fmt::join(parts, "; "));
  }

  const std::string& text_;
  std::string file_name_;
  sim::TestCase test_case_;
  sim::Vec2 center_ = sim::Vec2::Zero();  // of the arena in the file's coordinates, m
  struct Box {
    sim::ObstacleGene gene;
    std::string id;
  };
  std::vector<Box> boxes_;
  std::vector<std::string> obstacle_ids_;  // in the order of the test case's obstacles
  std::set<std::string_view> known_;       // elements that a file of ours has for ARGoS alone; {}: not ours
  std::set<int> walls_;
  std::int64_t robots_ = 0;
  std::vector<sim::Pose> poses_;  // of those that stand in the file by themselves
  int movable_ = 0;
  int low_ = 0;
  std::vector<std::string> ignored_;
};

}  // namespace

Result<LoadedCase> ParseArgos(const std::string& text, const std::string& file_name) {
  return Importer(text, file_name).Import();
}

}  // namespace gauntlet
