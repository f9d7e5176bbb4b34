#include "proto/case_json.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "proto/json_text.h"
#include "proto/run_codec.h"

namespace gauntlet::proto {
namespace {

using Json = nlohmann::json;

// "orientationDeg" of "orientation_deg".
std::string CamelCase(std::string_view name) {
  std::string camel;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool capital = name[i] == '_' && i + 1 < name.size();
    camel += capital ? static_cast<char>(name[++i] - 'a' + 'A') : name[i];
  }
  return camel;
}

// Reads a document into plain structs. The first complaint wins; what is read after it does not matter.
class CaseReader {
 public:
  const std::optional<std::string>& complaint() const { return complaint_; }

  void Read(const Json& document, CaseDocument& into) {
    std::vector<Key> keys = KeysOf(into.test_case);
    keys.push_back({"lineage", Into(into.lineage)});
    Object(keys)(document, "");
  }

 private:
  // Reads a value that stands at this path of the document.
  using Reader = std::function<void(const Json& value, const std::string& path)>;
  struct Key {
    std::string_view name;
    Reader read;
  };

  void Complain(const std::string& what) {
    if (!complaint_) complaint_ = what;
  }
  void Want(const std::string& wanted, const Json& value, const std::string& path) {
    std::string found = value.is_array() ? "a list" : value.is_object() ? "an object" : value.dump();
    if (value.is_string()) found = fmt::format("the text \"{}\"", value.get_ref<const std::string&>());
    Complain(fmt::format("{} must be {}, not {}", path.empty() ? "the document" : path, wanted, found));
  }

  Reader Object(const std::vector<Key>& keys) {
    return [this, keys](const Json& value, const std::string& path) {
      if (!value.is_object()) return Want("an object { ... }", value, path);
      std::set<std::string_view> given;
      for (const auto& [name, member] : value.items()) {
        const auto key = std::find_if(keys.begin(), keys.end(), [&name = name](const Key& one) {
          return one.name == name || CamelCase(one.name) == name;
        });
        if (key == keys.end()) {
          return Complain((path.empty() ? "" : path + ": ") + UnknownName("key", name, keys));
        }
        const std::string its_path = path.empty() ? name : path + "." + name;
        if (!given.insert(key->name).second) return Complain(its_path + " is given under two spellings");
        if (!member.is_null()) key->read(member, its_path);
      }
    };
  }

  static double NumberIn(const Json& value) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (value.is_number()) return value.get<double>();
    if (!value.is_string()) return kNone;
    const std::string& text = value.get_ref<const std::string&>();
    double number = 0.0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && stop == text.data() + text.size() ? number : kNone;
  }

  Reader Into(double& target) {
    return [this, &target](const Json& value, const std::string& path) {
      target = NumberIn(value);
      if (!std::isfinite(target)) Want("a finite number", value, path);
    };
  }

  Reader Into(int& target) {
    return [this, &target](const Json& value, const std::string& path) {
      constexpr int kMost = std::numeric_limits<int>::max();
      const double number = NumberIn(value);
      if (std::floor(number) != number || std::fabs(number) > kMost) {
        return Want(fmt::format("a whole number of at most {}", kMost), value, path);
      }
      target = static_cast<int>(number);
    };
  }

  Reader Into(std::string& target) {
    return [this, &target](const Json& value, const std::string& path) {
      if (!value.is_string()) return Want("a text in double quotes", value, path);
      target = value.get<std::string>();
      if (target.size() > kMaxNameBytes) {
        Complain(fmt::format("{} has {} bytes, {} are possible", path, target.size(), kMaxNameBytes));
      }
    };
  }

  Reader Into(sim::Color& target) {
    return [this, &target](const Json& value, const std::string& path) {
      if (!value.is_string()) return Want("a text in double quotes", value, path);
      const std::string& name = value.get_ref<const std::string&>();
      const std::optional<sim::Color> light = sim::ColorNamed(name);
      target = light.value_or(sim::Color::kBlack);
      if (light) return;
      Complain(fmt::format("{}: '{}' is no colour of lights; known: {}", path, name,
                           fmt::join(sim::kColorNames, ", ")));
    };
  }

  template <typename Value>
  Reader Into(std::optional<Value>& target) {
    return
        [this, &target](const Json& value, const std::string& path) { Into(target.emplace())(value, path); };
  }

  template <typename Value>
  Reader Into(std::vector<Value>& target) {
    return [this, &target](const Json& value, const std::string& path) {
      if (!value.is_array()) return Want("a list [ ... ]", value, path);
      for (std::size_t i = 0; i < value.size() && !complaint_; ++i)
        Into(target.emplace_back())(value[i], fmt::format("{}[{}]", path, i));
    };
  }

  Reader Into(std::array<double, 2>& pair) {
    return [this, &pair](const Json& value, const std::string& path) {
      if (!value.is_array() || value.size() != 2) return Want("a list of two numbers", value, path);
      for (std::size_t i = 0; i < 2; ++i) Into(pair[i])(value[i], fmt::format("{}[{}]", path, i));
    };
  }

  Reader Into(sim::Vec2& point) {
    point.setZero();
    return Object({{"x", Into(point.x())}, {"y", Into(point.y())}});
  }

  Reader Into(sim::Rectangle& area) {
    return Object({{"min_x", Into(area.min.x())},
                   {"min_y", Into(area.min.y())},
                   {"max_x", Into(area.max.x())},
                   {"max_y", Into(area.max.y())}});
  }

  Reader Into(sim::Pose& pose) {
    pose.position.setZero();
    return Object(
        {{"x", Into(pose.position.x())}, {"y", Into(pose.position.y())}, {"heading", Into(pose.heading)}});
  }

  Reader Into(sim::ObstacleGene& gene) {
    return Object({{"x", Into(gene.x)},
                   {"y", Into(gene.y)},
                   {"length", Into(gene.length)},
                   {"width", Into(gene.width)},
                   {"orientation_deg", Into(gene.orientation_deg)},
                   {"motion", Object({{"speed", Into(gene.speed)}, {"path", Into(gene.path)}})},
                   {"light", Into(gene.light)}});
  }

  std::vector<Key> KeysOf(sim::TestCase& test_case) {
    return {{"name", Into(test_case.name)},           {"side_x", Into(test_case.side_x)},
            {"side_y", Into(test_case.side_y)},       {"wall_thickness", Into(test_case.wall_thickness)},
            {"obstacles", Into(test_case.obstacles)}, {"spawn_area", Into(test_case.spawn_area)},
            {"robots", Into(test_case.robots)},       {"start_poses", Into(test_case.start_poses)},
            {"center_x", Into(test_case.center.x())}, {"center_y", Into(test_case.center.y())}};
  }
  Reader Into(sim::TestCase& test_case) { return Object(KeysOf(test_case)); }

  Reader Into(CaseFailures& found) {
    return Object({{"k", Into(found.failures)}, {"n", Into(found.runs)}, {"interval", Into(found.interval)}});
  }

  Reader Into(CaseStep& step) {
    return Object(
        {{"change", Into(step.change)}, {"obstacles", Into(step.obstacles)}, {"found", Into(step.found)}});
  }

  Reader Into(CaseLineage& lineage) {
    return Object({{"made_by", Into(lineage.made_by)},
                   {"failing", Into(lineage.failing)},
                   {"parent", Into(lineage.parent)},
                   {"steps", Into(lineage.steps)},
                   {"verified", Into(lineage.verified)}});
  }

  std::optional<std::string> complaint_;
};

nlohmann::ordered_json JsonOf(const sim::Vec2& point) {
  return {{"x", point.x()}, {"y", point.y()}};
}

nlohmann::ordered_json JsonOf(const sim::ObstacleGene& gene) {
  nlohmann::ordered_json written = {{"x", gene.x},
                                    {"y", gene.y},
                                    {"length", gene.length},
                                    {"width", gene.width},
                                    {"orientation_deg", gene.orientation_deg}};
  if (gene.speed != 0.0 || !gene.path.empty()) {
    nlohmann::ordered_json path = nlohmann::ordered_json::array();
    for (const sim::Vec2& point : gene.path) path.push_back(JsonOf(point));
    written["motion"] = {{"speed", gene.speed}, {"path", path}};
  }
  if (gene.Lit()) written["light"] = sim::NameOf(gene.light);
  return written;
}

nlohmann::ordered_json JsonOf(const sim::TestCase& test_case) {
  nlohmann::ordered_json written = {{"name", test_case.name},
                                    {"side_x", test_case.side_x},
                                    {"side_y", test_case.side_y},
                                    {"wall_thickness", test_case.wall_thickness}};
  if (test_case.center.x() != 0.0) written["center_x"] = test_case.center.x();
  if (test_case.center.y() != 0.0) written["center_y"] = test_case.center.y();
  written["obstacles"] = nlohmann::ordered_json::array();
  for (const sim::ObstacleGene& gene : test_case.obstacles) written["obstacles"].push_back(JsonOf(gene));
  if (const auto& area = test_case.spawn_area) {
    written["spawn_area"] = {{"min_x", area->min.x()},
                             {"min_y", area->min.y()},
                             {"max_x", area->max.x()},
                             {"max_y", area->max.y()}};
  }
  if (test_case.robots) written["robots"] = *test_case.robots;
  for (const sim::Pose& pose : test_case.start_poses) {
    written["start_poses"].push_back(
        {{"x", pose.position.x()}, {"y", pose.position.y()}, {"heading", pose.heading}});
  }
  return written;
}

nlohmann::ordered_json JsonOf(const CaseFailures& found) {
  return {{"k", found.failures}, {"n", found.runs}, {"interval", found.interval}};
}

nlohmann::ordered_json JsonOf(const CaseLineage& lineage) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const CaseStep& step : lineage.steps) {
    steps.push_back({{"change", step.change}, {"obstacles", step.obstacles}, {"found", JsonOf(step.found)}});
  }
  return {{"made_by", lineage.made_by},
          {"failing", lineage.failing},
          {"verified", JsonOf(lineage.verified)},
          {"steps", std::move(steps)},
          {"parent", JsonOf(lineage.parent)}};
}

}  // namespace

Result<CaseDocument> ParseCaseDocument(const std::string& text, const std::string& file_name) {
  TRY(const auto json, ParseJson(text, file_name));
  CaseDocument document;
  CaseReader reader;
  reader.Read(json, document);
  if (reader.complaint()) return InvalidInput(Printable(file_name + ": " + *reader.complaint()));
  sim::TestCase& test_case = document.test_case;
  if (!test_case.robots && !test_case.start_poses.empty())
    test_case.robots = static_cast<int>(test_case.start_poses.size());
  return document;
}

std::string WriteCaseDocument(const CaseDocument& document) {
  nlohmann::ordered_json written = JsonOf(document.test_case);
  if (document.lineage) written["lineage"] = JsonOf(*document.lineage);
  return JsonText(written);
}

Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name) {
  TRY(auto document, ParseCaseDocument(text, file_name));
  return std::move(document.test_case);
}

std::string WriteCaseJson(const sim::TestCase& test_case) {
  return WriteCaseDocument({test_case});
}

}  // namespace gauntlet::proto
