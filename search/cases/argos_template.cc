#include "search/cases/argos_template.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/split.h"
#include "base/utf8.h"

namespace gauntlet {
namespace {

using pugi::xml_node;

constexpr const char* kRecorder = "gauntlet_recorder";
constexpr const char* kTrajectory = "gauntlet-trajectory.csv";
// What a file's own visualization is called as long as the recorder stands in its place.
constexpr const char* kSetAside = "gauntlet_visualization";
// Likewise of a library that a campaign keeps.
constexpr const char* kLibrarySetAside = "gauntlet_library";
constexpr double kLargestParameter = 1e15;

std::optional<std::vector<double>> NumbersOf(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string& part : Split(text, ',')) {
    const std::optional<double> number = ParseNumber<double>(Trimmed(part));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::string TextOf(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

void Set(xml_node node, const char* name, const std::string& value) {
  if (!node.attribute(name)) node.append_attribute(name);
  node.attribute(name).set_value(value.c_str());
}

// A part of a parameter's name.
std::string NamePart(std::string_view text) {
  std::string part;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    part += plain ? c : '_';
  }
  return part;
}

class Maker {
 public:
  Maker(const std::string& text, std::string file_name, const ArgosTemplateOptions& options)
      : text_(text), file_name_(std::move(file_name)), options_(options) {}

  Result<ArgosTemplate> Make() {
    TRY(Load());
    TRY(TakeLength());
    TRY(TakeArena());
    FindPaths(root_);
    SetFramework();
    SetVisualization();
    TakeParameters();
    EscapeMarks(root_);
    MarkParameters();
    AppendObstacles();
    made_.text = TextOf(document_);
    return std::move(made_);
  }

 private:
  Error Fail(std::ptrdiff_t offset, std::string_view message) const {
    const std::string place = PlaceIn(text_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return InvalidInput(Printable(fmt::format("{}:{}: {}", file_name_, place, message)));
  }
  Error Fail(const xml_node& node, std::string_view message) const {
    return Fail(node.offset_debug(), message);
  }

  void Differs(std::string element, std::string meaning) {
    made_.differs.push_back({std::move(element), std::move(meaning)});
  }

  Status Load() {
    const pugi::xml_parse_result parsed = document_.load_buffer(
        text_.data(), text_.size(), pugi::parse_default | pugi::parse_comments | pugi::parse_declaration);
    if (!parsed) return Fail(parsed.offset, fmt::format("malformed XML: {}", parsed.description()));
    root_ = document_.document_element();
    if (std::string_view(root_.name()) != "argos-configuration")
      return Fail(root_,
                  fmt::format("the root element is <{}>, expected <argos-configuration>", root_.name()));
    for (const char* name : {"framework", "controllers", "arena", "physics_engines"}) {
      const xml_node first = root_.child(name);
      if (!first) return Fail(root_, fmt::format("there is no <{}>, which ARGoS wants", name));
      if (const xml_node second = first.next_sibling(name))
        return Fail(second, fmt::format("a second <{}>: ARGoS reads the first one only", name));
    }
    if (!root_.child("framework").child("experiment"))
      return Fail(root_.child("framework"), "there is no <experiment>, which ARGoS wants");
    return Ok{};
  }

  Status TakeLength() {
    xml_node experiment = root_.child("framework").child("experiment");
    const std::string_view own = experiment.attribute("length").value();
    const std::optional<double> length = ParseNumber<double>(Trimmed(own));
    made_.length = options_.length > 0.0 ? options_.length : length.value_or(0.0);
    if (!(made_.length > 0.0) || !std::isfinite(made_.length))
      return Fail(experiment,
                  fmt::format("<experiment> has length=\"{}\": such a run ends only when somebody "
                              "closes the window. Say how long runs are, in s: --length S",
                              own));
    if (!length || *length != made_.length)
      Differs("framework/experiment length", fmt::format("{} s instead of \"{}\"", made_.length, own));
    Set(experiment, "length", NumberText(made_.length));
    return Ok{};
  }

  Status TakeArena() {
    const xml_node arena = root_.child("arena");
    const auto size = NumbersOf(arena.attribute("size").value());
    const auto center =
        arena.attribute("center") ? NumbersOf(arena.attribute("center").value()) : std::vector{0.0, 0.0, 0.0};
    if (!size || size->size() < 2 || !((*size)[0] > 0.0) || !((*size)[1] > 0.0))
      return Fail(arena, fmt::format("<arena> has size=\"{}\", expected x,y,z in m",
                                     arena.attribute("size").value()));
    if (!center || center->size() < 2)
      return Fail(arena, fmt::format("<arena> has center=\"{}\", expected x,y,z in m",
                                     arena.attribute("center").value()));
    const sim::Vec2 middle((*center)[0], (*center)[1]);
    const sim::Vec2 half((*size)[0] / 2.0, (*size)[1] / 2.0);
    made_.arena = {middle - half, middle + half};
    made_.taken_over.push_back(fmt::format("arena of {} x {} m", (*size)[0], (*size)[1]));
    for (const xml_node box : arena.children("box")) TakeBox(box);
    for (const xml_node light : arena.children("light")) TakeLight(light);
    return Ok{};
  }

  void TakeLight(const xml_node& light) {
    const auto position = NumbersOf(light.attribute("position").value());
    if (!position || position->size() < 3) return;
    made_.lights.push_back({.position = {(*position)[0], (*position)[1]},
                            .height = (*position)[2],
                            .intensity = light.attribute("intensity").as_double(1.0),
                            .color = light.attribute("color").as_string("yellow")});
  }

  void TakeBox(const xml_node& box) {
    const auto size = NumbersOf(box.attribute("size").value());
    const auto position = NumbersOf(box.child("body").attribute("position").value());
    const xml_node body = box.child("body");
    const auto turned =
        body.attribute("orientation") ? NumbersOf(body.attribute("orientation").value()) : std::vector{0.0};
    if (!size || size->size() < 2 || !position || position->size() < 2 || !turned) return;
    const double degrees = std::fmod(std::fmod((*turned)[0], 360.0) + 360.0, 360.0);
    made_.boxes[box.attribute("id").value()] = {(*position)[0], (*position)[1], (*size)[0], (*size)[1],
                                                degrees};
  }

  void SetFramework() {
    xml_node system = root_.child("framework").child("system");
    if (const int threads = system.attribute("threads").as_int(); threads != 0) {
      Differs("framework/system threads", fmt::format("0 instead of {}", threads));
      Set(system, "threads", "0");
    }
    xml_node experiment = root_.child("framework").child("experiment");
    if (experiment.attribute("real_time").as_bool()) {
      Differs("framework/experiment real_time", "runs do not wait for the clock");
      experiment.remove_attribute("real_time");
    }
    if (xml_node profiling = root_.child("framework").child("profiling")) {
      Differs("framework/profiling", "left out: it writes times, which differ from run to run");
      profiling.parent().remove_child(profiling);
    }
    const std::string seed = experiment.attribute("random_seed").value();
    Differs("framework/experiment random_seed",
            seed.empty() ? "each run has a seed of its own"
                         : fmt::format("each run has a seed of its own instead of {}", seed));
  }

  void SetVisualization() {
    if (xml_node own = root_.child("visualization")) {
      Differs("visualization", "the recorder stands in its place; 'export --format argos' puts it back");
      own.set_name(kSetAside);
    }
    while (root_.child("visualization")) root_.remove_child("visualization");
    xml_node recorder = root_.append_child("visualization").append_child(kRecorder);
    Set(recorder, "file", kTrajectory);
    Set(recorder, "every", NumberText(options_.every));
  }

  // All numeric attributes below, named by their path.
  void TakeNumbers(xml_node element, const std::string& path) {
    for (pugi::xml_attribute attribute : element.attributes()) {
      const std::optional<double> value = ParseNumber<double>(Trimmed(attribute.value()));
      std::string name = path.empty() ? "" : path + ".";
      name += NamePart(attribute.name());
      if (!value || !(std::abs(*value) < kLargestParameter) || !IsName(name)) continue;
      while (!names_.insert(name).second) name += "_";  // of another id that differs in what no name has
      made_.parameters.push_back({name, *value});
      numbers_.emplace_back(attribute, name);
    }
    std::map<std::string, int> counts;
    for (const xml_node child : element.children()) {
      if (child.type() != pugi::node_element) continue;
      const int number = ++counts[child.name()];
      const std::string step = NamePart(child.name()) + (number > 1 ? fmt::format("-{}", number) : "");
      TakeNumbers(child, path.empty() ? step : path + "." + step);
    }
  }

  void TakeParameters() {
    std::size_t controllers = 0;
    for (const xml_node child : root_.child("controllers").children())
      if (child.type() == pugi::node_element) {
        ++controllers;
        made_.controllers.emplace_back(child.name());
      }
    for (xml_node controller : root_.child("controllers").children()) {
      if (controller.type() != pugi::node_element) continue;
      TakeLibrary(controller);
      const std::string id = controllers > 1 ? NamePart(controller.attribute("id").value()) : "";
      TakeNumbers(controller.child("params"), id);
      for (const char* devices : {"sensors", "actuators"})
        TakeNumbers(controller.child(devices), id.empty() ? devices : id + "." + devices);
    }
    if (const xml_node loop = root_.child("loop_functions")) {
      TakeLibrary(loop);
      TakeNumbers(loop, "loop_functions");
      made_.taken_over.push_back(fmt::format("loop functions \"{}\"", loop.attribute("label").value()));
    }
    made_.taken_over.push_back(
        fmt::format("{} {}", controllers, controllers == 1 ? "controller" : "controllers"));
    made_.taken_over.push_back(Counted(made_.parameters.size(), "parameter"));
  }

  void TakeLibrary(xml_node element) {
    const std::string library = element.attribute("library").value();
    if (const auto moved = options_.moved_libraries.find(library); moved != options_.moved_libraries.end()) {
      Set(element, "library", moved->second);
      Set(element, kLibrarySetAside, library);
    }
    if (!library.empty() && std::ranges::count(made_.libraries, library) == 0)
      made_.libraries.push_back(library);
  }

  // A value with a dot or a slash that is no list of numbers.
  void FindPaths(const xml_node& element) {
    for (const pugi::xml_attribute attribute : element.attributes()) {
      const std::string_view value = attribute.value();
      const bool like_one = value.find_first_of("./") != std::string_view::npos && !NumbersOf(value);
      if (like_one && std::string_view(attribute.name()) != "library") made_.paths.emplace_back(value);
    }
    for (const xml_node child : element.children()) FindPaths(child);
  }

  // What stands in the file as @ is @ in what is made of it.
  static std::string Escaped(std::string_view text) {
    std::string escaped;
    for (const char c : text) escaped += c == '@' ? std::string("@@") : std::string(1, c);
    return escaped;
  }
  static void EscapeMarks(xml_node node) {
    if (std::string_view(node.value()).find('@') != std::string_view::npos)
      node.set_value(Escaped(node.value()).c_str());
    for (pugi::xml_attribute attribute : node.attributes()) {
      if (std::string_view(attribute.value()).find('@') != std::string_view::npos)
        attribute.set_value(Escaped(attribute.value()).c_str());
    }
    for (const xml_node child : node.children()) EscapeMarks(child);
  }

  void MarkParameters() {
    for (auto& [attribute, name] : numbers_) attribute.set_value(("@parameters." + name + "@").c_str());
    Set(root_.child("framework").child("experiment"), "random_seed", "@seed@");
  }

  void AppendObstacles() {
    xml_node arena = root_.child("arena");
    arena.append_child(pugi::node_comment).set_value(" @obstacles@ ");
    xml_node box = arena.append_child("box");
    Set(box, "id", "gauntlet_obstacle_@number@");
    Set(box, "size", "@length@,@width@," + NumberText(options_.height));
    Set(box, "movable", "false");
    xml_node body = box.append_child("body");
    Set(body, "position", "@x@,@y@,0");
    Set(body, "orientation", "@degrees@,0,0");
    arena.append_child(pugi::node_comment).set_value(" @end@ ");
  }

  const std::string& text_;
  std::string file_name_;
  ArgosTemplateOptions options_;
  pugi::xml_document document_;
  xml_node root_;
  ArgosTemplate made_;
  std::set<std::string> names_;
  std::vector<std::pair<pugi::xml_attribute, std::string>> numbers_;
};

}  // namespace

Result<ArgosTemplate> MakeArgosTemplate(const std::string& text, const std::string& file_name,
                                        const ArgosTemplateOptions& options) {
  return Maker(text, file_name, options).Make();
}

std::string WithoutRecorder(const std::string& filled) {
  pugi::xml_document document;
  if (!document.load_string(filled.c_str(),
                            pugi::parse_default | pugi::parse_comments | pugi::parse_declaration))
    return filled;
  xml_node root = document.document_element();
  if (!root.child("visualization").child(kRecorder)) return filled;
  root.remove_child("visualization");
  root.child(kSetAside).set_name("visualization");
  while (xml_node moved =
             root.find_node([](const xml_node& node) { return bool(node.attribute(kLibrarySetAside)); })) {
    Set(moved, "library", moved.attribute(kLibrarySetAside).value());
    moved.remove_attribute(kLibrarySetAside);
  }
  return TextOf(document);
}

std::string WithWorld(const std::string& filled, const std::string& world) {
  pugi::xml_document document;
  document.load_string(filled.c_str(), pugi::parse_default | pugi::parse_comments | pugi::parse_declaration);
  Set(document.document_element().child("visualization").child(kRecorder), "world", world);
  return TextOf(document);
}

}  // namespace gauntlet
