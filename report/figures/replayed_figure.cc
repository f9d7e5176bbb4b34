#include "report/figures/replayed_figure.h"

#include <fmt/format.h>

#include "controllers/registry.h"
#include "proto/run_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {

std::string MetricText(const controllers::MetricInfo* info, double value) {
  if (info == nullptr) return fmt::format("{:.6g}", value);
  if (info->none == value) return "none";
  if (info->unit == "yes/no") return value == 0.0 ? "no" : "yes";
  if (info->unit == "rad") return fmt::format("{:.4g} deg", value / sim::kDegree);
  if (info->unit.empty()) return fmt::format("{:.6g}", value);
  return fmt::format("{:.6g} {}", value, info->unit);
}

analysis::RunFigure FigureOf(const std::string& experiment_name, const ReplayReport& report) {
  analysis::RunFigure figure;
  figure.experiment = experiment_name;
  figure.run = fmt::format("run {}", proto::RunText(report.stored.id));
  figure.spec = report.spec;
  figure.result = report.replayed;
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(figure.spec);
  figure.style = scenario.style;
  for (const auto& [name, value] : figure.result.metrics) {
    const auto* info = controllers::FindMetric(scenario, name);
    figure.metrics.emplace_back(name, MetricText(info, value));
  }
  return figure;
}

}  // namespace gauntlet
