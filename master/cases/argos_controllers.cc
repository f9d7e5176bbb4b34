#include "master/cases/argos_controllers.h"

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

namespace gauntlet::master {
namespace {

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

std::string TextOf(const std::vector<pugi::xml_node>& sections) {
  std::ostringstream text;
  for (const pugi::xml_node& section : sections) section.print(text, "  ");
  return text.str();
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
  if (Status parsed = Parse(text, file_name, document); !parsed) return parsed.error();
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

Result<ArgosControllers> ReadArgosControllers(const std::string& text, const std::string& file_name,
                                              const std::string& id) {
  const auto fail = [&](std::ptrdiff_t offset, std::string_view message) {
    return ErrorAt(text, file_name, offset, message);
  };
  pugi::xml_document document;
  if (Status parsed = Parse(text, file_name, document); !parsed) return parsed.error();
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
  if (id.empty() ? tested.size() == 1 : ids.contains(id))
    return ArgosControllers{TextOf(sections), id.empty() ? *tested.begin() : id};
  const std::string there = fmt::format("{}", fmt::join(ids, ", "));
  if (!id.empty())
    return InvalidInput(
        Printable(fmt::format("{} has no controller '{}'; it has: {}", file_name, id, there)));
  return InvalidInput(Printable(
      fmt::format("{} has several controllers: choose one by --controller, of: {}", file_name, there)));
}

ArgosControllers WithParameters(ArgosControllers controllers, const sim::Parameters& parameters) {
  pugi::xml_document document;
  document.load_string(controllers.sections.c_str(), pugi::parse_default | pugi::parse_fragment);
  const pugi::xml_node chosen = document.find_child_by_attribute("id", controllers.id.c_str());
  for (const auto& [path, value] : parameters) {
    const std::size_t dot = path.rfind('.');
    std::string elements = path.substr(0, dot == std::string::npos ? 0 : dot);
    std::ranges::replace(elements, '.', '/');
    pugi::xml_attribute attribute =
        chosen.child("params")
            .first_element_by_path(elements.c_str())
            .attribute(path.substr(dot == std::string::npos ? 0 : dot + 1).c_str());
    const std::optional<double> there = ParseNumber<double>(attribute.value());
    if (there && *there != value) attribute.set_value(fmt::format("{}", value).c_str());
  }
  controllers.sections = TextOf(ElementsOf(document));
  return controllers;
}

}  // namespace gauntlet::master
