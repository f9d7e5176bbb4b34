#include "argos/plugin_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "argos/controller_adapter.h"
#include "base/number_text.h"

namespace gauntlet::argos_form {
namespace {

using Lines = std::span<const ConfigurationLine>;

constexpr std::string_view kLinkRange = "link_range";
constexpr double kMostValue = 1e9;  // of a parameter whose default is no larger
constexpr std::size_t kMostName = 64;

std::optional<double> NumberIn(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool IsName(std::string_view name) {
  return !name.empty() && name.size() <= kMostName && std::ranges::all_of(name, [](char c) {
    return std::string_view("._-").find(c) != std::string_view::npos || (c >= '0' && c <= '9') ||
           (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
}

// The lines below the first one, which is an element.
Lines Below(Lines lines) {
  std::size_t end = 1;
  while (end < lines.size() && lines[end].depth > lines[0].depth) ++end;
  return lines.subspan(1, end - 1);
}

// The elements of one depth among these lines, each with what is below it.
std::vector<Lines> Elements(Lines lines, int depth) {
  std::vector<Lines> elements;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].depth != depth || lines[i].value != nullptr) continue;
    elements.push_back(lines.subspan(i, Below(lines.subspan(i)).size() + 1));
  }
  return elements;
}

std::vector<std::string> TagsIn(Lines section, std::string_view group) {
  std::vector<std::string> tags;
  for (const Lines element : Elements(section, 1)) {
    if (element[0].name != group) continue;
    for (const Lines device : Elements(element, 2)) tags.emplace_back(device[0].name);
  }
  return tags;
}

// Walks the attributes below <params> with their paths; the texts of its elements are in the nodes then.
template <typename Use>
void ForEachAttribute(Lines element, const std::string& path, argos::TConfigurationNode& node,
                      const Use& use) {
  const int depth = element[0].depth + 1;
  std::map<std::string, int> seen;
  for (std::size_t i = 1; i < element.size(); ++i) {
    const ConfigurationLine& line = element[i];
    if (line.depth != depth) continue;
    if (line.value != nullptr && *line.name == '\0') {
      node.SetText(line.value);
      continue;
    }
    if (line.value != nullptr) {
      use(path + line.name, line, node);
      continue;
    }
    const int number = ++seen[line.name];
    const std::string tag = number == 1 ? line.name : line.name + ("-" + std::to_string(number));
    argos::TConfigurationNode& child = node.AddChild(argos::TConfigurationNode(line.name));
    ForEachAttribute(element.subspan(i, Below(element.subspan(i)).size() + 1), path + tag + ".", child, use);
  }
}

// A controller of the library, with its section of the file if there is one.
struct Configured {
  std::string label;
  Lines section = {};
  std::vector<controllers::ParameterInfo> parameters = {};
  std::string description = "";

  // An attribute of the section itself; nothing when it is not there.
  std::optional<std::string> Attribute(std::string_view wanted) const {
    for (const ConfigurationLine& line : section) {
      if (line.depth == 1 && line.value != nullptr && line.name == wanted) return line.value;
    }
    return std::nullopt;
  }
  Lines Parameters() const {
    for (const Lines element : Elements(section, 1)) {
      if (std::string_view(element[0].name) == "params") return element;
    }
    return {};
  }

  void Describe();
  ControllerSection SectionWith(const sim::Parameters& resolved) const;
};

void Configured::Describe() {
  description =
      section.empty() ? "written for ARGoS" : "written for ARGoS, with the parameters of its .argos file";
  parameters.push_back({.name = std::string(kLinkRange),
                        .unit = "m",
                        .default_value = 1.35,
                        .min = 0.0,
                        .max = 10.0,
                        .description = "robots no farther apart are in one cluster in light-flocking and in "
                                       "scenarios of plug-ins; flocking and generic have a link_range of "
                                       "their own (ARGoS' flocking sample: 180 % of 75 cm)"});
  if (Parameters().empty()) return;
  argos::TConfigurationNode node;
  ForEachAttribute(Parameters(), "", node,
                   [&](const std::string& path, const ConfigurationLine& line, auto&) {
                     const std::optional<double> value = NumberIn(line.value);
                     if (!value || !IsName(path) || path == kLinkRange) return;
                     const double most = std::max(kMostValue, 10.0 * std::abs(*value));
                     parameters.push_back({.name = path,
                                           .unit = "",
                                           .default_value = *value,
                                           .min = -most,
                                           .max = most,
                                           .description = "as the .argos file has it, in its unit"});
                   });
}

ControllerSection Configured::SectionWith(const sim::Parameters& resolved) const {
  ControllerSection made = {.label = label};
  if (section.empty()) return made;
  if (const auto robots = Attribute(kRobotsLine)) made.robots = *robots;
  if (const auto bytes = Attribute(kMessageLine))
    made.message_bytes = static_cast<std::size_t>(NumberIn(*bytes).value_or(0.0));
  made.devices = ControllerSection::Devices{.actuators = TagsIn(section, "actuators"),
                                            .sensors = TagsIn(section, "sensors")};
  if (Parameters().empty()) return made;
  ForEachAttribute(Parameters(), "", made.parameters,
                   [&](const std::string& path, const ConfigurationLine& line, auto& node) {
                     const auto value = resolved.find(path);
                     const bool changed = value != resolved.end() && NumberIn(line.value) != value->second;
                     node.SetAttributeText(line.name, changed ? NumberText(value->second) : line.value);
                   });
  return made;
}

controllers::ControllerFactory FactoryOf(const Configured& configured, const sim::Parameters& resolved) {
  const auto section = std::make_shared<const ControllerSection>(configured.SectionWith(resolved));
  return {.create =
              [section](const controllers::ControllerContext& context) {
                return std::make_unique<ControllerAdapter>(
                    *section, ControllerAdapter::Robot{
                                  .number = context.robot, .seed = context.seed, .start = context.start});
              },
          .traits = {.link_range = resolved.at(std::string(kLinkRange))}};
}

template <typename Names>
std::string Listed(const Names& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

// A file whose controllers are all of other sources is the wrong file.
void CheckThatTheyMeet(Lines lines, const argos::CFactory<argos::CCI_Controller>::TTypeMap& creators) {
  std::set<std::string> there;
  for (const Lines section : Elements(lines, 0)) there.insert(section[0].name);
  if (there.empty() || creators.empty()) return;
  std::set<std::string> labels;
  for (const auto& [label, creator] : creators) {
    if (there.count(label) > 0) return;
    labels.insert(label);
  }
  throw std::runtime_error("<controllers> of the .argos file has " + Listed(there) +
                           ", but the sources register " + Listed(labels) +
                           " (REGISTER_CONTROLLER): they belong to different experiments");
}

}  // namespace

std::vector<controllers::ControllerInfo> ControllerRows(Lines lines) {
  using Factory = argos::CFactory<argos::CCI_Controller>;
  if (const auto& repeated = Factory::GetRepeatedLabels(); !repeated.empty()) {
    throw std::runtime_error("several classes are registered by one name: " + Listed(repeated) +
                             " (REGISTER_CONTROLLER); give each its own, or build each source alone");
  }
  CheckThatTheyMeet(lines, Factory::GetTypeMap());
  std::vector<controllers::ControllerInfo> rows;
  std::set<std::string> taken;
  for (const auto& [label, creator] : Factory::GetTypeMap()) {
    std::vector<Lines> sections;
    for (const Lines section : Elements(lines, 0)) {
      if (section[0].name == label) sections.push_back(section);
    }
    if (sections.empty()) sections.emplace_back();
    for (const Lines section : sections) {
      std::string name = label;
      if (taken.contains(name)) {
        for (const ConfigurationLine& line : section) {
          if (line.depth == 1 && line.value != nullptr && std::string_view(line.name) == "id")
            name = line.value;
        }
      }
      if (!taken.insert(name).second) continue;
      Configured configured{.label = label, .section = section};
      configured.Describe();
      rows.push_back(
          {name, std::string(controllers::kAnyScenario), configured.description, configured.parameters,
           [configured](const sim::Parameters& resolved) { return FactoryOf(configured, resolved); }});
    }
  }
  return rows;
}

}  // namespace gauntlet::argos_form
