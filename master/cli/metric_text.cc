#include "master/cli/metric_text.h"

#include <fmt/format.h>

#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::master {
namespace {

std::string MetricText(const controllers::MetricInfo* info, double value) {
  if (info == nullptr) return fmt::format("{:.6g}", value);
  if (info->may_be_none && value == -1.0) return "none";
  if (info->unit == "yes/no") return value == 0.0 ? "no" : "yes";
  if (info->unit == "rad") return fmt::format("{:.4g} deg", value / sim::kDegree);
  if (info->unit.empty()) return fmt::format("{:.6g}", value);
  return fmt::format("{:.6g} {}", value, info->unit);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> MetricTexts(
    std::string_view scenario, const std::vector<std::pair<std::string, double>>& metrics) {
  const controllers::ScenarioInfo* info = controllers::FindScenario(scenario);
  std::vector<std::pair<std::string, std::string>> texts;
  texts.reserve(metrics.size());
  for (const auto& [name, value] : metrics) {
    texts.emplace_back(name,
                       MetricText(info == nullptr ? nullptr : controllers::FindMetric(*info, name), value));
  }
  return texts;
}

}  // namespace gauntlet::master
