#include "search/cases/argos_controllers.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/split.h"
#include "base/utf8.h"

namespace gauntlet {
namespace {

constexpr int kMostMessageBytes = 65536;
constexpr int kMostDepth = 32;  // real files have 4

// As a C++ literal, whatever bytes it holds.
std::string Literal(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= ' ' && byte < 127 && c != '"' && c != '\\' && c != '?';
    literal += plain ? std::string(1, c) : fmt::format("\\{:03o}", byte);
  }
  return literal + "\"";
}

// False when it is nested deeper than any file is.
bool AppendLines(const pugi::xml_node& element, int depth, std::string& lines) {
  if (depth > kMostDepth) return false;
  lines += fmt::format("    {{{}, {}, nullptr}},\n", depth, Literal(element.name()));
  for (const pugi::xml_attribute attribute : element.attributes()) {
    lines += fmt::format("    {{{}, {}, {}}},\n", depth + 1, Literal(attribute.name()),
                         Literal(attribute.value()));
  }
  if (const std::string_view text = Trimmed(element.text().get()); !text.empty())
    lines += fmt::format("    {{{}, \"\", {}}},\n", depth + 1, Literal(text));
  for (const pugi::xml_node child : element.children()) {
    if (child.type() == pugi::node_element && !AppendLines(child, depth + 1, lines)) return false;
  }
  return true;
}

// "FILE:LINE:COLUMN: ...", the offset in bytes from the beginning.
Error ErrorAt(const std::string& text, const std::string& file_name, std::ptrdiff_t offset,
              std::string_view message) {
  const std::string place = PlaceIn(text, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  return InvalidInput(Printable(fmt::format("{}:{}: {}", file_name, place, message)));
}

std::vector<pugi::xml_node> ElementsOf(const pugi::xml_node& parent) {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xml_node child : parent.children())
    if (child.type() == pugi::node_element) elements.push_back(child);
  return elements;
}

// What ARGoS would miss in a controller; "" = nothing.
std::string MissingIn(const pugi::xml_node& section) {
  if (std::string_view(section.attribute("id").value()).empty()) return "id=\"...\"";
  for (const char* child : {"actuators", "sensors", "params"})
    if (!section.child(child)) return fmt::format("<{}>, which ARGoS wants even when it is empty", child);
  return "";
}

// What the file says of the robots that have a controller.
struct RobotsOf {
  std::optional<std::string> ids;  // what they begin with
  std::optional<int> message_bytes;
};

Result<RobotsOf> ReadRobots(const pugi::xml_node& root, const std::string& controller) {
  const pugi::xml_node robot = root.child("arena").find_node([&](const pugi::xml_node& node) {
    return std::string_view(node.name()) == "foot-bot" &&
           node.child("controller").attribute("config").value() == controller;
  });
  if (controller.empty() || (!robot && !root.child("arena"))) return RobotsOf{};
  // Loop functions make the robots: a controller that reads a number in its id finds it.
  if (!robot) return RobotsOf{.ids = "", .message_bytes = {}};
  // In <distribute> ARGoS appends numbers; elsewhere the file itself has.
  std::string ids = robot.attribute("id").value();
  if (std::string_view(robot.parent().name()) != "entity") ids.erase(ids.find_last_not_of("0123456789") + 1);
  RobotsOf robots{.ids = ids, .message_bytes = {}};
  const pugi::xml_attribute bytes = robot.attribute("rab_data_size");
  if (!bytes) return robots;
  robots.message_bytes = ParseNumber<int>(Trimmed(bytes.value()));
  if (robots.message_bytes && *robots.message_bytes >= 1 && *robots.message_bytes <= kMostMessageBytes)
    return robots;
  return InvalidInput(
      fmt::format("<foot-bot id=\"{}\"> has rab_data_size=\"{}\", expected bytes from 1 to {}",
                  robot.attribute("id").value(), bytes.value(), kMostMessageBytes));
}

std::string TextOf(const std::vector<pugi::xml_node>& sections) {
  std::ostringstream text;
  for (const pugi::xml_node& section : sections) section.print(text, "  ");
  return text.str();
}

pugi::xml_node ChosenOf(const ArgosControllers& controllers, pugi::xml_document& document) {
  document.load_string(controllers.sections.c_str(), pugi::parse_default | pugi::parse_fragment);
  return document.find_child_by_attribute("id", controllers.id.c_str());
}

// The child of a step of a path: `port-2` is the second <port>.
pugi::xml_node ChildAt(const pugi::xml_node& parent, const std::string& step) {
  if (const pugi::xml_node child = parent.child(step.c_str())) return child;
  const std::size_t dash = step.rfind('-');
  if (dash == std::string::npos) return {};
  int number = ParseNumber<int>(std::string_view(step).substr(dash + 1)).value_or(0);
  const std::string name = step.substr(0, dash);
  for (const pugi::xml_node& child : parent.children(name.c_str()))
    if (--number == 0) return child;
  return {};
}

// The attribute of a parameter, as argos/plugin_rows.h calls them; an empty one when it is not there.
pugi::xml_attribute AttributeAt(const pugi::xml_node& controller, const std::string& path) {
  const std::vector<std::string> steps = Split(path, '.');
  pugi::xml_node element = controller.child("params");
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) element = ChildAt(element, steps[i]);
  return element.attribute(steps.back().c_str());
}

Status Parse(const std::string& text, const std::string& file_name, pugi::xml_document& document) {
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (parsed) return Ok{};
  return ErrorAt(text, file_name, parsed.offset, fmt::format("malformed XML: {}", parsed.description()));
}

}  // namespace

Result<std::string> ArgosControllerTable(const std::string& text, const std::string& file_name) {
  const auto fail = [&](std::ptrdiff_t offset, std::string_view message) {
    return ErrorAt(text, file_name, offset, message);
  };
  pugi::xml_document document;
  TRY(Parse(text, file_name, document));
  const pugi::xml_node root = document.document_element();
  if (std::string_view(root.name()) != "argos-configuration") {
    return fail(root.offset_debug(),
                fmt::format("the root element is <{}>, expected <argos-configuration>", root.name()));
  }
  std::string lines;
  for (const pugi::xml_node section : root.child("controllers").children()) {
    if (section.type() != pugi::node_element) continue;
    if (!AppendLines(section, 0, lines)) {
      return fail(section.offset_debug(),
                  fmt::format("<{}> is nested deeper than {} elements", section.name(), kMostDepth));
    }
    const Result<RobotsOf> robots = ReadRobots(root, section.attribute("id").value());
    if (!robots) return fail(section.offset_debug(), robots.error().message);
    if (robots->ids)
      lines += fmt::format("    {{1, gauntlet::argos_form::kRobotsLine, {}}},\n", Literal(*robots->ids));
    if (robots->message_bytes)
      lines +=
          fmt::format("    {{1, gauntlet::argos_form::kMessageLine, \"{}\"}},\n", *robots->message_bytes);
  }
  if (lines.empty()) {
    return fail(root.offset_debug(),
                "there is no controller: expected <controllers> with an element for each");
  }
  return "#include \"argos/plugin_rows.h\"\n"
         "#include \"sdk/plugin.h\"\n\n"
         "namespace {\n\n"
         "constexpr gauntlet::argos_form::ConfigurationLine kLines[] = {\n" +
         lines +
         "};\n\n"
         "std::vector<gauntlet::controllers::ControllerInfo> Controllers() {\n"
         "  return gauntlet::argos_form::ControllerRows(kLines);\n"
         "}\n\n"
         "}  // namespace\n\n"
         "GAUNTLET_PLUGIN(Controllers)\n";
}

bool HasLoopFunctions(const std::string& text) {
  pugi::xml_document document;
  return document.load_buffer(text.data(), text.size()) &&
         document.document_element().child("loop_functions");
}

Result<ArgosControllers> ReadArgosControllers(const std::string& text, const std::string& file_name,
                                              const std::string& id) {
  const auto fail = [&](std::ptrdiff_t offset, std::string_view message) {
    return ErrorAt(text, file_name, offset, message);
  };
  pugi::xml_document document;
  TRY(Parse(text, file_name, document));
  const pugi::xml_node root = document.document_element();
  const bool bare = std::string_view(root.name()) == "controllers";
  const std::vector<pugi::xml_node> sections = ElementsOf(bare ? root : root.child("controllers"));
  if (sections.empty()) {
    return fail(
        root.offset_debug(),
        fmt::format("<{}> has no controller: expected <controllers> with an element for each", root.name()));
  }
  std::set<std::string> ids;
  for (const pugi::xml_node& section : sections) {
    if (const std::string missing = MissingIn(section); !missing.empty())
      return fail(section.offset_debug(), fmt::format("<{}> has no {}", section.name(), missing));
    const char* its_id = section.attribute("id").value();
    if (!ids.insert(its_id).second)
      return fail(section.offset_debug(), fmt::format("the id '{}' is given to two controllers", its_id));
  }
  const std::set<std::string> tested = [&] {
    std::set<std::string> others = ids;
    others.erase(kScenarioController);
    return others;
  }();
  if (id.empty() ? tested.size() == 1 : ids.contains(id)) {
    ArgosControllers read{.sections = TextOf(sections), .id = id.empty() ? *tested.begin() : id};
    const Result<RobotsOf> robots = ReadRobots(root, read.id);
    if (!robots) return fail(root.offset_debug(), robots.error().message);
    read.robots = robots->ids;
    read.message_bytes = robots->message_bytes;
    return read;
  }
  const std::string there = fmt::format("{}", fmt::join(ids, ", "));
  if (!id.empty())
    return InvalidInput(
        Printable(fmt::format("{} has no controller '{}'; it has: {}", file_name, id, there)));
  return InvalidInput(Printable(
      fmt::format("{} has several controllers: choose one by --controller, of: {}", file_name, there)));
}

ArgosControllers WithParameters(ArgosControllers controllers, const sim::Parameters& parameters) {
  pugi::xml_document document;
  const pugi::xml_node chosen = ChosenOf(controllers, document);
  for (const auto& [path, value] : parameters) {
    pugi::xml_attribute attribute = AttributeAt(chosen, path);
    const std::optional<double> there = ParseNumber<double>(attribute.value());
    if (there && *there != value) attribute.set_value(fmt::format("{}", value).c_str());
  }
  controllers.sections = TextOf(ElementsOf(document));
  return controllers;
}

std::string UnlikenessTo(const ArgosControllers& controllers, const std::string& controller,
                         const std::vector<std::string>& parameters) {
  pugi::xml_document document;
  const pugi::xml_node chosen = ChosenOf(controllers, document);
  std::vector<std::string> unlike;
  if (controller != chosen.name() && controller != controllers.id)
    unlike.push_back(fmt::format("it is a <{}>", chosen.name()));
  std::vector<std::string> missing;
  for (const std::string& path : parameters) {
    if (!AttributeAt(chosen, path)) missing.push_back(path);
  }
  if (!missing.empty()) unlike.push_back(fmt::format("it has no {}", fmt::join(missing, ", ")));
  return Printable(fmt::format("{}", fmt::join(unlike, ", and ")));
}

}  // namespace gauntlet
