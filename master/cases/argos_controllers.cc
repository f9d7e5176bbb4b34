#include "master/cases/argos_controllers.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/printable.h"
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
  for (const pugi::xml_node child : element.children()) {
    if (child.type() == pugi::node_element && !AppendLines(child, depth + 1, lines)) return false;
  }
  return true;
}

}  // namespace

Result<std::string> ArgosControllerTable(const std::string& text, const std::string& file_name) {
  const auto fail = [&](std::ptrdiff_t offset, std::string_view message) {
    const std::string place = PlaceIn(text, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return InvalidInput(Printable(fmt::format("{}:{}: {}", file_name, place, message)));
  };
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) return fail(parsed.offset, fmt::format("malformed XML: {}", parsed.description()));
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

}  // namespace gauntlet::master
